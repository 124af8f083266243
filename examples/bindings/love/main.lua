-- A soft car drives over a bridge that breaks: arrows or A and D drive, space jumps, the mouse drags, its right button
-- cuts, R starts again.
--
--   MASSSPRING_LIBRARY=build/src/libmassspring.so love examples/bindings/love
--
-- With --frames 600 --picture car.png it drives by itself for 600 frames, prints the state's hash and ends.
--
-- SPDX-License-Identifier: MIT
local World = require("world")
local ms = require("massspring")

local world, camera, debt, cost, drawn, from
local asked = {}
local COLOURS = {
  car = { 0.91, 0.36, 0.17 }, wood = { 0.66, 0.45, 0.25 }, crate = { 0.93, 0.76, 0.36 },
  ground = { 0.16, 0.25, 0.27 }, grass = { 0.42, 0.68, 0.38 }, tyre = { 0.14, 0.15, 0.18 }, metal = { 0.75, 0.78, 0.82 },
}
local SLOW, TORN = 3, 1.7 -- most steps in a frame; how long an edge may be to be drawn, in spacings

local function start()
  world, debt, cost = World.new(), 0, 0
  camera = camera or { x = 8, y = 4, scale = 36 }
end

function love.load(arguments)
  for i = 1, #arguments, 2 do asked[arguments[i]:gsub("^%-%-", "")] = arguments[i + 1] end
  start()
  drawn = {
    sky = love.graphics.newMesh({ { 0, 0, 0, 0, 0.38, 0.62, 0.80 }, { 1, 0, 0, 0, 0.38, 0.62, 0.80 },
      { 1, 1, 0, 0, 0.98, 0.87, 0.74 }, { 0, 1, 0, 0, 0.98, 0.87, 0.74 } }, "fan"),
    small = love.graphics.newFont(13), large = love.graphics.newFont(22),
  }
end

local function mouse()
  local x, y = love.mouse.getPosition()
  local width, height = love.graphics.getDimensions()
  return camera.x + (x - width / 2) / camera.scale, camera.y - (y - height * 0.58) / camera.scale
end

local function drive()
  if asked.frames then return world.time > 0.5 and 1 or 0 end
  local down = love.keyboard.isDown
  return (down("right", "d") and 1 or 0) - (down("left", "a") and 1 or 0)
end

local function step()
  local began = love.timer.getTime()
  world:step(drive())
  cost = cost + 0.05 * (1000 * (love.timer.getTime() - began) - cost)
  local x, y = world:place()
  camera.x, camera.y = camera.x + 0.08 * (x + 4 - camera.x), camera.y + 0.05 * (y + 1.5 - camera.y)
end

-- Ends a run with --frames, with a picture of its last frame.
local function finish()
  io.write(("car: x %.3f m, %d springs broken, hash %s\n"):format(world:place(), world:broken(), world.network:hash()))
  love.graphics.captureScreenshot(function(image)
    if asked.picture then
      local file = assert(io.open(asked.picture, "wb"))
      file:write(image:encode("png"):getString())
      file:close()
    end
    love.event.quit()
  end)
  asked.frames = nil
  asked.done = true
end

function love.update(dt)
  if asked.done then return end
  if asked.frames then
    for _ = 1, asked.frames do step() end
    return finish()
  end
  world:drag(mouse())
  if from then
    local x, y = mouse()
    world:cut(from[1], from[2], x, y)
    from = { x, y }
  end
  debt = math.min(debt + dt, SLOW * World.DT)
  while debt >= World.DT do
    debt = debt - World.DT
    step()
  end
end

------------------------------------------------------------------------------------------------------------- drawing

local function hills(shift, base, size, red, green, blue)
  local width, height = love.graphics.getDimensions()
  local points = { 0, height }
  for x = 0, width + 40, 40 do
    local at = (x + shift) / width
    points[#points + 1], points[#points + 2] = x, base * height - size * (math.sin(3.1 * at) + 0.5 * math.sin(7.3 * at + 2))
  end
  points[#points + 1], points[#points + 2] = width + 40, height
  love.graphics.setColor(red, green, blue)
  for _, triangle in ipairs(love.math.triangulate(points)) do love.graphics.polygon("fill", triangle) end
end

local function ground()
  love.graphics.setColor(COLOURS.ground)
  local line = {}
  for i = -80, #world.heights + 80 do
    local x, low = (i - 1) * World.SPACING, -60
    local a, b = World.height(x), World.height(x + World.SPACING)
    love.graphics.polygon("fill", x, low, x, a, x + World.SPACING, b, x + World.SPACING, low)
    line[#line + 1], line[#line + 2] = x, a - 0.1
  end
  love.graphics.setColor(COLOURS.grass)
  love.graphics.setLineWidth(0.28)
  love.graphics.line(line)
end

-- Squares of a lattice whose corners are still together.
local function body(shape)
  local x, y, ids, width = world.x, world.y, shape.ids, shape.width
  local limit = (TORN * shape.spacing) ^ 2
  local function near(a, b) return (x[a] - x[b]) ^ 2 + (y[a] - y[b]) ^ 2 < limit end
  local colour = COLOURS[shape.kind]
  for row = 0, shape.height - 2 do
    local light = 1.08 - 0.3 * row / shape.height
    love.graphics.setColor(colour[1] * light, colour[2] * light, colour[3] * light)
    for column = 0, width - 2 do
      local a, b = ids[row * width + column], ids[row * width + column + 1]
      local d, c = ids[(row + 1) * width + column], ids[(row + 1) * width + column + 1]
      if a ~= ms.NONE and b ~= ms.NONE and c ~= ms.NONE and d ~= ms.NONE then
        if near(a, b) and near(b, c) and near(c, d) and near(d, a) then
          love.graphics.polygon("fill", x[a], y[a], x[b], y[b], x[c], y[c], x[d], y[d])
        end
      elseif a == ms.NONE and b ~= ms.NONE and c ~= ms.NONE and d ~= ms.NONE then
        love.graphics.polygon("fill", x[b], y[b], x[c], y[c], x[d], y[d])
      elseif b == ms.NONE and a ~= ms.NONE and c ~= ms.NONE and d ~= ms.NONE then
        love.graphics.polygon("fill", x[a], y[a], x[c], y[c], x[d], y[d])
      end
    end
  end
end

-- Springs under strain glow: blue if pressed, yellow if stretched.
local function strains(shape)
  love.graphics.setLineWidth(0.045)
  for spring = shape.first_spring, shape.last_spring do
    local a, b, strain = world.ends_a[spring], world.ends_b[spring], world.strains[spring]
    local size = math.min(1, math.abs(strain) / 0.03)
    if size > 0.12 and math.abs(strain) < 0.6 then
      if strain > 0 then love.graphics.setColor(1, 0.92, 0.3, size) else love.graphics.setColor(0.25, 0.6, 1, size) end
      love.graphics.line(world.x[a], world.y[a], world.x[b], world.y[b])
    end
  end
end

local function wheel(shape)
  local x, y, rim = world.x, world.y, {}
  for i = 0, shape.count - 1 do rim[2 * i + 1], rim[2 * i + 2] = x[shape.first + i], y[shape.first + i] end
  local hub_x, hub_y = x[shape.hub], y[shape.hub]
  love.graphics.setColor(COLOURS.tyre)
  for i = 1, #rim, 2 do
    local next_x, next_y = rim[i + 2] or rim[1], rim[i + 3] or rim[2]
    love.graphics.polygon("fill", hub_x, hub_y, rim[i], rim[i + 1], next_x, next_y)
  end
  love.graphics.setColor(COLOURS.metal)
  love.graphics.circle("fill", hub_x, hub_y, 0.5 * shape.radius, 24)
  love.graphics.setColor(COLOURS.tyre)
  love.graphics.setLineWidth(0.09)
  for i = 0, shape.count - 1, 3 do
    local px, py = x[shape.first + i], y[shape.first + i]
    love.graphics.line(hub_x, hub_y, hub_x + 0.48 * (px - hub_x), hub_y + 0.48 * (py - hub_y))
  end
end

local function words()
  local width, height = love.graphics.getDimensions()
  local x = world:place()
  love.graphics.setFont(drawn.large)
  love.graphics.setColor(0.1, 0.14, 0.18)
  love.graphics.print(("%d m   %d springs broken"):format(x, world:broken()), 20, 16)
  love.graphics.setFont(drawn.small)
  local time = asked.picture and "" or (", %.1f ms a step"):format(cost) -- pictures are the same on all machines
  love.graphics.print(("%d springs%s"):format(world.network:count(ms.SPRINGS), time), 21, 46)
  love.graphics.setColor(1, 1, 1, 0.85)
  love.graphics.print("arrows drive · space jumps · drag with the mouse · cut with its right button · R starts again", 20, height - 28)
end

function love.draw()
  local width, height = love.graphics.getDimensions()
  love.graphics.setColor(1, 1, 1)
  love.graphics.draw(drawn.sky, 0, 0, 0, width, height)
  hills(camera.x * 3, 0.62, 46, 0.62, 0.73, 0.76)
  hills(camera.x * 8 + 500, 0.72, 34, 0.45, 0.60, 0.60)
  love.graphics.push()
  love.graphics.translate(width / 2, height * 0.58)
  love.graphics.scale(camera.scale, -camera.scale)
  love.graphics.translate(-camera.x, -camera.y)
  ground()
  for _, shape in ipairs(world.bodies) do body(shape) end
  for _, shape in ipairs(world.wheels) do wheel(shape) end
  for _, shape in ipairs(world.bodies) do strains(shape) end
  love.graphics.pop()
  words()
end

------------------------------------------------------------------------------------------------------------- input

function love.keypressed(key)
  if key == "r" then start() end
  if key == "space" then world:jump() end
  if key == "escape" then love.event.quit() end
end

function love.mousepressed(_, _, button)
  local x, y = mouse()
  if button == 1 then world:grab(x, y) else from = { x, y } end
end

function love.mousereleased()
  world:let_go()
  from = nil
end

function love.wheelmoved(_, turned) camera.scale = math.max(8, math.min(80, camera.scale * 1.1 ^ turned)) end
