-- libmassspring for LÖVE and LuaJIT: copy this file and massspring_cdef.lua into a game, beside the shared library.
--
--   local ms = require("massspring")
--   local builder = ms.builder()
--   builder:lattice { width = 12, height = 4, cells = cells, materials = { { mass = 2, stiffness = 1e5 } } }
--   local network = builder:network { settings = { gravity_y = -9.8, substeps = 8 } }
--   network:step(1 / 60)
--   local x, y = network:positions()               -- C arrays, x[0] to x[network:count(ms.PARTICLES) - 1]
--   local strains = network:property(ms.STRAIN)    -- a C array, of all springs
--
-- Every function of the headers is a method: mspring_network_set_floor(network, def) is network:set_floor(def). If it
-- fails, it raises an error with its message. ms.def("floor_def", { ... }) makes a struct with its defaults; lists
-- become arrays. ms.C has the functions as they are, and ms.NONE, ms.PARTICLE_PINNED ... the constants without MSPRING_.
--
-- It looks for the library in the variable MASSSPRING_LIBRARY, next to the game, and in the system's folders.
--
-- SPDX-License-Identifier: MIT
local ffi = require("ffi")
local constants = require(((...) or ""):gsub("massspring$", "massspring_cdef"))

local function load_library()
  local extension = ({ Windows = "massspring.dll", OSX = "libmassspring.dylib" })[ffi.os] or "libmassspring.so"
  local tries = { os.getenv("MASSSPRING_LIBRARY") or extension, "massspring", extension .. ".0.3" }
  if love and love.filesystem then
    table.insert(tries, 2, love.filesystem.getSource() .. "/" .. extension)
    table.insert(tries, 3, love.filesystem.getSourceBaseDirectory() .. "/" .. extension)
  end
  local said = {}
  for _, name in ipairs(tries) do
    local found, library = pcall(ffi.load, name)
    if found then return library end
    said[#said + 1] = library
  end
  error("cannot load libmassspring:\n  " .. table.concat(said, "\n  "))
end

local C = load_library()
local ms = setmetatable({ C = C }, {
  __index = function(_, name) return constants[name] or C["MSPRING_" .. name] end,
})
local result_type = ffi.typeof("mspring_result")

local function check(result, object)
  if result == C.MSPRING_OK then return end
  error(("%s: %s"):format(ffi.string(C.mspring_result_string(result)), object and object:message() or ""), 3)
end

------------------------------------------------------------------------------------------------------ definitions

local elements = { -- of fields that point to arrays
  cells = "uint16_t", heights = "float", planes = "double", points = "double", triangles = "mspring_id",
  plane_frictions = "float", plane_restitutions = "float", height_frictions = "float", height_restitutions = "float",
  silt_depths = "float",
}
local counts = { heights = { "height_count", 1 }, planes = { "plane_count", 4 }, points = { "point_count", 2 } }
local anchors = setmetatable({}, { __mode = "k" }) -- a definition keeps what it points to

--- A list as a C array.
function ms.array(element, list) return ffi.new(element .. "[?]", #list, list) end

local function fill(made, values, kept)
  for name, value in pairs(values) do
    if type(value) ~= "table" then made[name] = value
    elseif name == "settings" then fill(made.settings, value, kept)
    else
      if name == "material" then value = { value } end
      if name == "material" or name == "materials" then
        local list = ffi.new("mspring_material[?]", #value)
        for i, material in ipairs(value) do list[i - 1] = ms.def("material", material) end
        if name == "materials" then made.material_count = #value end
        value = list
      else
        if counts[name] then made[counts[name][1]] = #value / counts[name][2] end
        value = ms.array(assert(elements[name], name .. " is no list"), value)
      end
      kept[#kept + 1], made[name] = value, value
    end
    if type(value) == "cdata" then kept[#kept + 1] = value end
  end
end

--- A struct of the headers with its defaults and these values: ms.def("grip_def", { particle = 3 }).
function ms.def(kind, values)
  if ffi.istype("mspring_" .. kind, values) then return values end
  local made, kept = ffi.new("mspring_" .. kind), {}
  check(C.mspring_init(C["MSPRING_STRUCT_" .. kind:upper()], made, ffi.sizeof(made)))
  fill(made, values or {}, kept)
  anchors[made] = kept
  return made
end

---------------------------------------------------------------------------------------------------------- objects

-- A class whose methods are the functions that begin with that prefix, unless it has better ones.
local function class(prefix)
  local known = setmetatable({}, {
    __index = function(known, name)
      local call = C[prefix .. name]
      local function method(self, ...)
        local result = call(self.handle, ...)
        if not ffi.istype(result_type, result) then return result end
        check(result, self)
      end
      known[name] = method
      return method
    end,
  })
  return { __index = known }, known
end

local Network, network = class("mspring_network_")
local Builder, builder = class("mspring_builder_")

--- A reading call that fails keeps its message until a call that may change: one that does nothing lets the next one
--- have its own.
function network:message()
  local text = ffi.string(self:error())
  C.mspring_network_read_events(self.handle, nil, 0, ffi.new("uint32_t[1]"), nil)
  return text
end

--- The builder forgets its error, which is raised, and so goes on.
function builder:message()
  local text = ffi.string(self:error())
  self:forget_error()
  return text
end

local function make(metatable, handle, destroy)
  return setmetatable({ handle = ffi.gc(handle, destroy) }, metatable)
end

--- A description to which you add particles, springs and lattices.
function ms.builder()
  local out = ffi.new("mspring_builder *[1]")
  check(C.mspring_builder_create(nil, out))
  return make(Builder, out[0], C.mspring_builder_destroy)
end

local function number(out) return tonumber(out[0]) end
local id = ffi.typeof("mspring_id[1]")

function builder:particle(values)
  local out = id()
  self:add_particles(ms.def("particle_def", values), 1, out)
  return number(out)
end

function builder:spring(values)
  local out = id()
  self:add_springs(ms.def("spring_def", values), 1, out)
  return number(out)
end

--- Returns the particle of each cell as a C array, top row first; ms.NONE where there is none.
function builder:lattice(values)
  local def = ms.def("lattice_def", values)
  local ids = ffi.new("mspring_id[?]", def.width * def.height)
  self:add_lattice(def, ids)
  return ids
end

--- Returns its first particle, which is the centre, and its first spring. The rim comes last.
function builder:disc(values)
  local particle, spring = id(), id()
  self:add_disc(ms.def("disc_def", values), particle, spring)
  return number(particle), number(spring)
end

--- Makes a network. You can still add to the builder.
function builder:network(values)
  local out = ffi.new("mspring_network *[1]")
  check(C.mspring_network_create(self.handle, ms.def("network_def", values), out), self)
  return make(Network, out[0], C.mspring_network_destroy)
end

--- World positions of all particles, in two C arrays. Pass them again to reuse them.
function network:positions(x, y)
  local count = self:count(C.MSPRING_PARTICLES)
  x, y = x or ffi.new("double[?]", count), y or ffi.new("double[?]", count)
  self:get_positions(nil, 0, count, x, y, 1)
  return x, y
end

--- A property of all things of its kind, as ms.STRAIN of all springs, in a C array. Pass it again to reuse it.
function network:property(property, values)
  local count, is_integer = self:count(bit.rshift(property, 8)), bit.band(property, 0x80) ~= 0
  values = values or ffi.new(is_integer and "uint32_t[?]" or "float[?]", count)
  self[is_integer and "get_integers" or "get"](self, property, nil, 0, count, values, 1)
  return values
end

--- Measures particles as one body: network:body(first, count).x and so on.
function network:body(first, count)
  local body = ms.def("body")
  self:get_body(nil, first, count, body)
  return body
end

function network:grip(values)
  local out = id()
  self:add_grip(ms.def("grip_def", values), out)
  return number(out)
end

function network:collider(values)
  local out = id()
  self:add_collider(ms.def("collider_def", values), out)
  return number(out)
end

--- The particle that is nearest, and its distance; nil if none is within that reach.
function network:nearest(x, y, within)
  local out, distance = id(), ffi.new("double[1]")
  self:nearest_particle(x, y, within, out, distance)
  if out[0] ~= constants.NONE then return number(out), distance[0] end
end

--- The ids of springs that the line crosses, in a C array, and how many there are.
function network:crossed(from_x, from_y, to_x, to_y)
  local count, all = ffi.new("uint32_t[1]"), self:count(C.MSPRING_SPRINGS)
  local found = ffi.new("mspring_id[?]", all)
  self:springs_across(from_x, from_y, to_x, to_y, ms.FIND_WHOLE, found, nil, all, count)
  return found, number(count)
end

function network:info()
  local info = ms.def("step_info")
  self:get_step_info(info)
  return info
end

--- All that the following steps depend on, as a string, for rollback and network play.
function network:save()
  local size = ffi.new("size_t[1]")
  self:get_snapshot_size(C.MSPRING_SNAPSHOT_FRAME, size)
  local bytes = ffi.new("uint8_t[?]", size[0])
  check(C.mspring_network_save(self.handle, C.MSPRING_SNAPSHOT_FRAME, bytes, size[0], nil), self)
  return ffi.string(bytes, size[0])
end

function network:load(snapshot)
  check(C.mspring_network_load(self.handle, snapshot, #snapshot), self)
end

--- Sixteen digits, which equal states have on every machine.
function network:hash()
  local out = ffi.new("uint64_t[1]")
  self:get_state_hash(out)
  return bit.tohex(tonumber(out[0] / 2 ^ 32)) .. bit.tohex(tonumber(out[0] % 2 ^ 32))
end

return ms
