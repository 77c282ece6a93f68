local proto, F, problem, guarded = protocol("armctl_yerc", "Yaskawa high-speed Ethernet server", T.fields)

-- Addresses of clients, last request by addresses and id, and what is known of each packet.
local clients, requests, frames
function proto.init() clients, requests, frames = {}, {}, {} end

local function row_of(request)
  for _, row in ipairs(T.rows) do
    if row.is_file == request.is_file and
        (row.is_file and row.services[request.service] and row.is_backup == (request.data == T.backup_path) or
          not row.is_file and row.number == request.command) then return row end
  end
  -- Only a save has the path of the batch backup.
  if request.is_file and request.data == T.backup_path then
    return row_of({ is_file = true, service = request.service, data = "" })
  end
end

local function title_of(request)
  local row = request.row
  if row then return row.is_file and row.name or ("0x%02x %s"):format(row.number, row.name) end
  if request.is_file then return ("unknown file service 0x%02x"):format(request.service) end
  return ("unknown command 0x%02x"):format(request.command)
end

local function label(spans, instance)
  for _, span in ipairs(spans) do
    if span.first <= instance and instance <= span.last then
      if not span.prefix then return span.meaning end
      local name = span.prefix .. (span.from + instance - span.first)
      return span.meaning == "" and name or name .. ", " .. span.meaning
    end
  end
end

-- Name of an instance. Both names, if the name depends on the model.
local function instance_name(request)
  local row = request.row or { fs100 = {}, dx200 = {} }
  local fs100, dx200 = label(row.fs100, request.instance), label(row.dx200, request.instance)
  if fs100 == dx200 then return dx200 and "(" .. dx200 .. ")" or "(not defined)" end
  if not dx200 then return "(fs100: " .. fs100 .. ")" end
  return fs100 and "(fs100: " .. fs100 .. "; dx200: " .. dx200 .. ")" or "(dx200: " .. dx200 .. ")"
end

local function block_name(block)
  local number = block % 0x80000000
  if number == block then return ("block %d"):format(number) end
  return number == 0 and "single frame" or ("block %d, the last block"):format(number)
end

-- Reader of the bytes from front to back. After the first missing byte, it adds nothing.
local Reader = {}
Reader.__index = Reader

function Reader:left() return self.tvb:len() - self.at end

function Reader:take(name, size)
  if self.problem then return end
  if size > self:left() then
    self.problem = ("the frame ends inside '%s' at offset %d"):format(name, self.at)
    return
  end
  self.at = self.at + size
  return self.tvb:range(self.at - size, size)
end

function Reader:rest(name, about)
  local size = self:left()
  if size == 0 or self.problem then return end
  about = about or size .. " bytes"
  self.tree:add(F.data, self:take(name, size), about):set_text(name .. ": " .. about)
end

function Reader:parts(parts)
  local values = {}
  for _, part in ipairs(parts) do
    local range = self:take(part.name, part.size)
    if range then
      values[part.key] = part.size <= 4 and range:le_uint() or nil
      self.tree:add_le(F[part.key], range)
    end
  end
  return values
end

local function flags(bits, word)
  local words, reserved = {}, word
  for _, bit in ipairs(bits) do
    local on = bit_of(word, bit[1])
    if on then reserved = reserved - 2 ^ bit[1] end
    local name = on and bit[3] or bit[2]
    if name ~= "" then words[#words + 1] = name end
  end
  if reserved ~= 0 then words[#words + 1] = ("reserved 0x%x"):format(reserved) end
  return table.concat(words, ", ")
end

local function text_of(raw) return '"' .. escaped(raw:match("^[^\0]*")) .. '"' end

-- Meaning of a field. `known` has the value of the last choice, on which units depend.
local function meaning(field, range, known)
  local form, kind = field.form, field.type
  if kind == "STRING" then
    local text = text_of(range:raw())
    return range:raw() == T.backup_path and text .. " (creates or reads the batch backup)" or text
  end
  if kind == "FLOAT" then return float_text(range:le_float()) end
  local value = kind:find("^INT") and range:le_int() or range:le_uint()
  if form.signals then
    local digits = ""
    for bit = 7, 0, -1 do digits = digits .. (bit_of(value, bit) and "1" or "0") end
    return digits .. ", highest signal first"
  end
  if form.reserved then return "reserved, 0" end
  if form.bits then return flags(form.bits, value) end
  if form.choices then
    known.choice = value
    return ("%d: %s"):format(value, form.choices[value] or "not defined")
  end
  local unit = form.unit
  if form.units then
    unit = form.units[known.choice] or known.choice and form.other
    if not unit then
      return ("%d"):format(value) .. (form.other and ", in the unit of the data type" or "")
    end
  end
  return unit and decimal(value, unit) .. " " .. unit.symbol or ("%d"):format(value)
end

-- Adds one element. It may end early after a complete field, because controllers omit missing axes.
function Reader:element(fields, prefix, is_request)
  local known = {}
  for _, field in ipairs(fields) do
    local size = field.form.is_rest and self:left() or field.size
    if self:left() == 0 and not (field.form.is_rest and size == 0) and not is_request then return end
    local name = prefix .. field.name
    if size == 0 then return end
    local range = self:take(name, size)
    if not range then return end
    self.tree:add_le(F[field.key], range):set_text(name .. ": " .. meaning(field, range, known))
  end
end

local function total(fields)
  local size = 0
  for _, field in ipairs(fields) do size = size + field.size end
  return size
end

function Reader:payload(request, is_request)
  local row = request.row
  local service = row and row.services[request.service]
  if not service then return end
  if row.plural then
    local range = self:take("count", 4)
    if not range then return end
    local count, remark = range:le_uint(), ""
    if count == 0 or count > row.plural.max then
      remark = (", not allowed: 1 to %d"):format(row.plural.max)
    elseif row.plural.even and count % 2 == 1 then
      remark = ", not allowed: even counts only"
    end
    self.tree:add_le(F.count, range):set_text(("count: %d%s"):format(count, remark))
    local number = request.instance
    while self:left() > 0 and not self.problem and (service.is_write or not is_request) do
      self:element(row.fields, number .. " ", is_request)
      number = number + 1
    end
    return
  end
  local fields = row.fields
  if service.by_field then fields = { row.fields[request.attribute] } end
  if row.alternative and total(row.alternative) == self:left() then fields = row.alternative end
  self:element(fields, "", is_request)
end

-- The problem of the frame as a whole.
local function damage_of(tvb)
  local len = tvb:len()
  if len < T.header_len then return ("%d bytes are too short"):format(len) end
  if len > T.max_frame then return ("%d bytes are too long"):format(len) end
  local at = 0
  for _, part in ipairs(T.header) do
    local value = part.size <= 4 and tvb:range(at, part.size):le_uint()
    local is_valid = not part.valid
    for _, valid in ipairs(part.valid or {}) do is_valid = is_valid or valid == value end
    if not is_valid then return ("%s at offset %d is %d"):format(part.name, at, value) end
    if part.key == "data_size" and value ~= len - T.header_len then
      return ("data size at offset %d is %d, but %d bytes follow the header"):format(at, value, len - T.header_len)
    end
    at = at + part.size
  end
end

local function request_of(tvb)
  local request = {
    is_file = tvb:range(9, 1):uint() == 2,
    command = tvb:range(24, 2):le_uint(),
    instance = tvb:range(26, 2):le_uint(),
    attribute = tvb:range(28, 1):uint(),
    service = tvb:range(29, 1):uint(),
    data = tvb:len() > T.header_len and tvb:range(T.header_len):raw() or "",
  }
  request.row = row_of(request)
  return request
end

-- What the packets before this one tell about it: its sender, and the request that it answers.
local function frame_of(tvb, pinfo)
  local frame = frames[pinfo.number]
  if frame then return frame end
  local from, to = from_to(pinfo)
  local function byte(at) return at < tvb:len() and tvb:range(at, 1):uint() or 0 end
  local is_client = byte(10) == 0 or
      tvb:len() >= 30 and tvb:range(24, 4):uint() == 0 and byte(28) == 0 and byte(29) ~= 0
  if clients[from] then is_client = true elseif clients[to] then is_client = false end
  frame = { is_client = is_client, damage = damage_of(tvb) }
  if not is_client then
    frame.request = requests[to .. from .. byte(11)]
    if frame.request then frame.request.answer = frame.request.answer or pinfo.number end
  elseif not frame.damage and byte(10) == 0 then
    clients[from] = true
    frame.request = request_of(tvb)
    frame.request.number = pinfo.number
    requests[from .. to .. byte(11)] = frame.request
  end
  frames[pinfo.number] = frame
  return frame
end

local function add_request(tree, request, is_answer)
  local row, service = request.row, request.row and request.row.services[request.service]
  if is_answer then
    add_generated(tree, F.request_in, request.number)
    if not request.is_file then add_generated(tree, F.command, request.command) end
    add_generated(tree, F.instance, request.instance)
    add_generated(tree, F.attribute, request.attribute)
  else
    add_generated(tree, F.response_in, request.answer)
  end
  if not request.is_file then add_generated(tree, F.instance_name, instance_name(request)) end
  add_generated(tree, F.section, row and row.section)
  add_generated(tree, F.action, service and service.meaning)
  add_generated(tree, F.risk, service and (service.risks[request.instance] or service.risk))
end

local function client(reader, frame, id, block)
  local values = reader:parts(T.client)
  if not values.service then return "truncated" end
  local request = frame.request or request_of(reader.tvb)
  local name, row = title_of(request), request.row
  local service = row and row.services[request.service]
  local size = reader:left()
  if reader.is_ack then
    reader:rest("file data")
    return ("#%d %s: %s, %s, %d bytes"):format(id, size == 0 and "ack" or "data", name, block_name(block), size)
  end
  if row and service and (row.is_file or service.is_write or row.plural) then reader:payload(request, true) end
  reader:rest("data", "not expected")
  add_request(reader.tree, request, false)
  if request.is_file then return ("#%d %s '%s'"):format(id, name, escaped(request.data)) end
  return ("#%d %s: instance %d %s, attribute %d, %s, %d bytes"):format(id, name, request.instance,
    instance_name(request), request.attribute, service and service.meaning or "unknown service", size)
end

local function status_words(values)
  local added = ""
  if values.added_status_size == 1 then
    added = (", added status %04X"):format(values.added_status % 0x10000)
  elseif values.added_status_size ~= 0 then
    added = (", added status %08X"):format(values.added_status)
  end
  return (values.status == 0 and "ok" or ("refused, status 0x%02x"):format(values.status)) .. added
end

local function controller(reader, frame, id, block)
  local values = reader:parts(T.controller)
  if not values.added_status then return "truncated" end
  local request, size = frame.request, reader:left()
  local row, answered = request and request.row, values.service - T.answer_bit
  if row and values.status == 0 and not row.is_file then
    if row.services[request.service] and not row.services[request.service].is_write then
      reader:payload(request, false)
    end
    reader:rest("data", "more data than the command has")
  elseif row or reader.is_file then
    local list = not row and T.list_service == answered
    reader:rest(list and "names" or "file data", list and text_of(reader.tvb:range(T.header_len):raw()) or nil)
  else
    reader:rest("data", "depends on the command")
  end
  if request then add_request(reader.tree, request, true) end
  return ("#%d answer%s: %s%s, %d bytes"):format(id, request and " to " .. title_of(request) or "",
    status_words(values), block == 0x80000000 and "" or ", " .. block_name(block), size)
end

local function dissect(tvb, pinfo, root)
  if tvb:len() < 4 or tvb:range(0, 4):string() ~= T.identifier then return 0 end
  pinfo.cols.protocol = "YERC"
  local frame = frame_of(tvb, pinfo)
  local tree = root:add(proto, tvb:range())
  local reader = setmetatable({ tvb = tvb, tree = tree, at = 0 }, Reader)
  local values = reader:parts(T.header)
  reader.is_ack, reader.is_file = values.ack == 1, values.processing_division == 2
  local summary = (frame.is_client and client or controller)(reader, frame, values.request_id, values.block_number)
  local damage = frame.damage or reader.problem
  if damage then problem(tree, damage) end
  pinfo.cols.info = frame.damage and "no valid frame: " .. frame.damage or summary
  return tvb:len()
end

proto.dissector = guarded(dissect)
proto:register_heuristic("udp", function(tvb, pinfo, root)
  if tvb:len() < 4 or tvb:range(0, 4):string() ~= T.identifier then return false end
  proto.dissector(tvb, pinfo, root)
  return true
end)
for _, port in ipairs(T.ports) do DissectorTable.get("udp.port"):add(port, proto) end
