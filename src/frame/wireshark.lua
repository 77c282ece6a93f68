-- A protocol with its filter fields: rows of key, name, type, base and names of values. Returns the protocol, its fields
-- by key, and a function that reports a problem of a packet.
local function protocol(name, title, rows)
  local proto, fields, list = Proto(name, title), {}, {}
  for _, row in ipairs(rows) do
    local values
    for _, pair in ipairs(row.values or {}) do
      values = values or {}
      values[pair[1]] = pair[2]
    end
    local abbr = name .. "." .. row.key
    local field
    if row.type == "FRAMENUM" then
      field = ProtoField.framenum(abbr, row.name)
    else
      field = ProtoField.new(row.name, abbr, ftypes[row.type], values, base[row.base])
    end
    fields[row.key] = field
    list[#list + 1] = field
  end
  proto.fields = list
  local damaged = ProtoExpert.new(name .. ".problem", "Damaged", expert.group.MALFORMED, expert.severity.WARN)
  local failed = ProtoExpert.new(name .. ".failed", "Dissector failed", expert.group.DEBUG, expert.severity.ERROR)
  proto.experts = { damaged, failed }
  local function problem(item, text) item:add_proto_expert_info(damaged, text) end
  -- A mistake in a dissector must not hide the packet.
  local function guarded(dissect)
    return function(tvb, pinfo, root, ...)
      local ok, result = pcall(dissect, tvb, pinfo, root, ...)
      if ok then return result end
      root:add_proto_expert_info(failed, tostring(result))
      return 0
    end
  end
  return proto, fields, problem, guarded
end

-- A field of another protocol. Without its plugin, it has no values.
local function field_of(name)
  local ok, field = pcall(Field.new, name)
  return ok and field or function() end
end

local function bit_of(word, bit) return math.floor(word / 2 ^ bit) % 2 == 1 end

-- Number in units of its last decimal, with its unit.
local function decimal(value, unit) return ("%." .. unit.decimals .. "f"):format(value / 10 ^ unit.decimals) end

-- The shortest text of a single-precision number.
local function float_text(value)
  for digits = 1, 9 do
    local text = ("%." .. digits .. "g"):format(value)
    if math.abs(tonumber(text) - value) <= math.abs(value) * 2 ^ -25 then return text end
  end
  return tostring(value)
end

local ESCAPES = { ["\t"] = "\\t", ["\r"] = "\\r", ["\n"] = "\\n", ["'"] = "\\'", ['"'] = '\\"', ["\\"] = "\\\\" }

-- Printable ASCII, with escapes for all other bytes.
local function escaped(text)
  return (text:gsub("[%c\128-\255'\"\\]", function(char) return ESCAPES[char] or ("\\x%02x"):format(char:byte()) end))
end

-- Adds a value that is not in the bytes of the packet.
local function add_generated(tree, field, value)
  if value ~= nil then return tree:add(field, value):set_generated() end
end

-- Bytes that are not together in the packet.
local function new_tvb(bytes, name)
  return ByteArray.new((bytes:gsub(".", function(char) return ("%02x"):format(char:byte()) end))):tvb(name)
end

local function from_to(pinfo)
  local from = tostring(pinfo.src) .. ":" .. tostring(pinfo.src_port)
  return from, tostring(pinfo.dst) .. ":" .. tostring(pinfo.dst_port)
end

-- Captures of serial lines that armctl recorded: a byte with the direction, then the bytes. Each dissector of the list
-- returns nil if the bytes are not its own.
local line_dissectors = {}
local line = Proto("armctl_line", "Serial line recorded by armctl")
function line.dissector(tvb, pinfo, root)
  if tvb:len() < 2 then return 0 end
  for _, dissect in ipairs(line_dissectors) do
    local size = dissect(tvb:range(1):tvb(), pinfo, root, tvb:range(0, 1):uint() == 0)
    if size then return size end
  end
  return 0
end
DissectorTable.get("wtap_encap"):add((wtap or wtap_encaps).USER0, line)
