-- The world of the demo without a window: a soft car, a canyon with a bridge that breaks, and crates.
--
-- SPDX-License-Identifier: MIT
local ffi = require("ffi")
local ms = require("massspring")

local World = {}
World.__index = World

World.DT = 1 / 60
World.WIDTH, World.SPACING = 190, 0.5 -- m
World.CANYON = { from = 44, to = 66, depth = 16 }
local DECK = { rows = 3, spacing = 0.4 }
local CAR = { -- a row of text is a row of cells
  spacing = 0.36,
  "....#####......",
  "...#######.....",
  "..#########....",
  "##############.",
  "###############",
  "###############",
  ".#############.",
}
local WHEEL = { radius = 0.95, rings = 3, columns = { 2, 12 } }
local TORQUE, FASTEST, JUMP = 3000, 18, 5 -- N m of each wheel, the rad/s at which none is left; m/s
local LEAN = 0.25 -- of the torque turns the body back; all of it would have cars do somersaults

-- Metres above 0: hills, the canyon, then a long rise to the crates.
local function height(x)
  local hills = 1.3 * math.sin(0.16 * x) + 0.5 * math.sin(0.37 * x + 1)
  local level = math.min(1, math.max(0, math.min(math.abs(x - 34), math.abs(x - 76)) / 8))
  if x > 34 and x < 76 then level = 0 end
  local y = hills * level
  local into = math.min(x - World.CANYON.from, World.CANYON.to - x)
  return y - World.CANYON.depth * math.min(1, math.max(0, into / 2.5))
end

local function cells_of(rows)
  local cells = {}
  for _, row in ipairs(rows) do
    for column = 1, #row do cells[#cells + 1] = row:sub(column, column) == "#" and 0 or ms.CELL_EMPTY end
  end
  return cells, #rows[1], #rows
end

-- Adds a lattice and remembers it as a body to draw. Without cells it is full.
function World:add(builder, kind, cells, width, rows, x, y, spacing, materials)
  local first_spring = builder:count(ms.SPRINGS)
  local ids = builder:lattice { width = width, height = rows, x = x, y = y, spacing = spacing, cells = cells, materials = materials }
  local body = { kind = kind, ids = ids, width = width, height = rows, spacing = spacing,
    first_spring = first_spring, last_spring = builder:count(ms.SPRINGS) - 1 }
  self.bodies[#self.bodies + 1] = body
  return body
end

function World:add_bridge(builder)
  local canyon = World.CANYON
  local columns = math.floor((canyon.to - canyon.from + 2) / DECK.spacing) + 1
  local cells = {}
  for row = 1, DECK.rows do
    for column = 1, columns do cells[#cells + 1] = (column <= 3 or column > columns - 3) and 1 or 0 end
  end
  local wood = { mass = 8, stiffness = 5e6, damping = 0.2, break_strain = 0.06, spring_flags = ms.SPRING_DAMPING_RATIO }
  local held = { mass = 8, stiffness = 5e6, damping = 0.2, spring_flags = wood.spring_flags, particle_flags = ms.PARTICLE_PINNED }
  return self:add(builder, "wood", cells, columns, DECK.rows, canyon.from - 1, -0.9, DECK.spacing, { wood, held })
end

function World:add_car(builder, x, y)
  local metal = { mass = 7, stiffness = 6e5, damping = 0.3, yield_strain = 0.05, hardening = 0.3, plastic_limit = 0.3,
    spring_flags = ms.SPRING_DAMPING_RATIO }
  local cells, width, rows = cells_of(CAR)
  local body = self:add(builder, "car", cells, width, rows, x, y, CAR.spacing, { metal })
  self.car, self.wheels = body, {}
  self.body_count = builder:count(ms.PARTICLES) -- they are the first
  local rubber = { damping = 0.25, spring_flags = ms.SPRING_DAMPING_RATIO }
  for _, column in ipairs(WHEEL.columns) do
    local hub_x, hub_y = x + column * CAR.spacing, y - 0.45
    local hub = builder:disc { x = hub_x, y = hub_y, radius = WHEEL.radius, ring_count = WHEEL.rings, area_density = 40,
      young_modulus = 3e5, material = rubber }
    local all, rim = builder:count(ms.PARTICLES) - hub, 6 * WHEEL.rings
    local wheel = { hub = hub, all = all, first = hub + all - rim, count = rim, radius = WHEEL.radius, speed = 0 }
    -- Two struts hold the hub from the sides and one carries the weight.
    for _, strut in ipairs { { -2, 5, 1.5e5 }, { 2, 5, 1.5e5 }, { 0, 4, 7e4 } } do
      local cell = body.ids[strut[2] * width + column + strut[1]]
      builder:spring { a = hub, b = cell, stiffness = strut[3], damping = 0.35, flags = ms.SPRING_DAMPING_RATIO }
    end
    self.wheels[#self.wheels + 1] = wheel
  end
end

function World.new()
  local self = setmetatable({ bodies = {}, held = nil, time = 0, drive = 0 }, World)
  local builder = ms.builder()
  self:add_car(builder, 8, 3.2)
  self.car_count = builder:count(ms.PARTICLES)
  self.bridge = self:add_bridge(builder)
  local box = { mass = 3, stiffness = 9e4, damping = 0.4, break_strain = 0.5, spring_flags = ms.SPRING_DAMPING_RATIO }
  for row = 0, 3 do
    for column = 0, 3 - row do
      local x = 116 + 1.75 * (column + row / 2)
      self:add(builder, "crate", nil, 5, 5, x, height(118) + 1.2 + 1.75 * row, 0.36, { box })
    end
  end
  self.network = builder:network { settings = { gravity_y = -9.8, substeps = 20, global_damping = 0.02 } }
  self.heights = {}
  for i = 0, World.WIDTH / World.SPACING do self.heights[i + 1] = height(i * World.SPACING) end
  self.network:set_floor(ms.def("floor_def", { heights = self.heights, spacing = World.SPACING, friction = 1.1,
    planes = { 1, 0, 1, 0, World.WIDTH - 1, 0, -1, 0 } }))
  self.network:set_contact(ms.def("contact_def", { flags = 0, friction = 0.7, thickness = 0.12 }))
  self.ends_a, self.ends_b = self.network:property(ms.END_A), self.network:property(ms.END_B)
  self:read()
  return self
end

function World:read()
  self.x, self.y = self.network:positions(self.x, self.y)
  self.strains = self.network:property(ms.STRAIN, self.strains)
end

-- A torque turns a wheel, and a part of it the body the other way.
function World:turn(wheel, torque)
  self.network:apply_torque(nil, wheel.hub, wheel.all, -torque)
  self.network:apply_torque(nil, 0, self.body_count, LEAN * torque)
end

--- drive: -1 back to 1 on.
function World:step(drive)
  for _, wheel in ipairs(self.wheels) do self:turn(wheel, TORQUE * (drive - wheel.speed / FASTEST) * math.abs(drive)) end
  self.network:step(World.DT)
  self.time = self.time + World.DT
  self:read()
  for _, wheel in ipairs(self.wheels) do wheel.speed = -self.network:body(wheel.hub, wheel.all).spin end
end

--- All of the car gets a push upwards.
function World:jump()
  local masses = self.network:property(ms.MASS)
  local x, y = ffi.new("float[?]", self.car_count), ffi.new("float[?]", self.car_count)
  for i = 0, self.car_count - 1 do y[i] = JUMP * masses[i] end
  self.network:apply_forces(ms.PUSH_IMPULSE, nil, 0, self.car_count, x, y, 1)
end

function World:grab(x, y)
  local particle = self.network:nearest(x, y, 1.5)
  if particle then
    self.held = self.network:grip { particle = particle, x = x, y = y, stiffness = 2e4, damping = 800, max_force = 3e4 }
    self.held_particle = particle
  end
end

function World:drag(x, y)
  if self.held then self.network:move_grip(self.held, x, y) end
end

function World:let_go()
  if self.held then self.network:remove_grip(self.held) end
  self.held = nil
end

function World:cut(from_x, from_y, to_x, to_y)
  local springs, count = self.network:crossed(from_x, from_y, to_x, to_y)
  if count > 0 then self.network:break_springs(springs, 0, count) end
end

function World:place()
  local body = self.network:body(0, self.body_count)
  return body.x, body.y
end

function World:broken()
  local flags, count = self.network:property(ms.SPRING_FLAGS), 0
  for spring = 0, self.network:count(ms.SPRINGS) - 1 do
    if bit.band(flags[spring], ms.SPRING_BROKEN) ~= 0 then count = count + 1 end
  end
  return count
end

World.height = height
return World
