local proto, F, problem, guarded = protocol("armctl_yrcx", "YRCX remote commands and signals", T.fields)

-- Last images and last command of each controller, changes of each packet, and unfinished DeviceNet images.
local links, packets, fragments
function proto.init() links, packets, fragments = {}, {}, {} end

-- Words of an image. An image with signals only has no other words.
local function words_of(bytes)
  if #bytes == T.signals_len then
    bytes = ("\0"):rep(T.command_words * 2) .. bytes .. ("\0"):rep(T.image_len - T.command_words * 2 - #bytes)
  end
  local words = {}
  for word = 0, T.image_len / 2 - 1 do
    local low, high = bytes:byte(word * 2 + 1, word * 2 + 2)
    words[word] = low + high * 256
  end
  return words
end

local function read(field, tvb)
  local range, form, data = tvb:range(field.word * 2, field.words * 2), field.form, field.data
  if form == "bits" then
    local raw = math.floor(range:le_uint() / 2 ^ data.low) % data.size
    if data.show.kind ~= "digits" then return raw end
    local tens, units = math.floor(raw / 16), raw % 16
    return tens < 10 and units < 10 and tens * 10 + units or 100 + raw
  end
  if form == "real" then return range:le_float() end
  if form ~= "text" then return range:le_int() end
  return (range:raw():gsub("[\0 ]+$", ""):gsub("[^ -~]", "\239\191\189"))
end

local function show(field, value)
  local form, how = field.form, field.data
  if form == "text" then return value end
  if form == "real" then return float_text(value) end
  if form == "bits" then how = how.show end
  if how.decimals then return decimal(value, how) end
  if how.choices then return how.choices[value] or ("undocumented (%d)"):format(value) end
  if how.format then return how.format:format(math.floor(value / how.divisor), value % how.divisor) end
  if how.kind == "set" then
    local bits = {}
    for bit = 0, 15 do
      if bit_of(value, bit) then bits[#bits + 1] = bit + 1 end
    end
    return value == 0 and "none" or table.concat(bits, ",")
  end
  if how.kind == "revision" then return ("R%04d"):format(value) end
  if how.kind == "line" and value > T.common_lines then return ("%d of COMMON"):format(value - T.common_lines) end
  return ("%d"):format(value)
end

-- The fields that words use, with their values. A condition can also refer to the values of the command.
local function values_of(layout, tvb, context)
  local flags, values = {}, {}
  for _, field in ipairs(layout) do
    if flags[field.key] == nil then flags[field.key] = read(field, tvb) end
  end
  for _, field in ipairs(layout) do
    local when = field.when
    local flag = when and (flags[when.key] or context and context[when.key] or 0)
    if not when or when.least <= flag and flag <= when.most then
      values[#values + 1] = { field = field, value = read(field, tvb) }
    end
  end
  return values
end

local function row_of(words)
  local row = T.rows[words[0] % 0x1000]
  return row and (words[0] < 0x1000 or row.has_robot) and row or nil
end

local function numbers(values)
  local by_key = {}
  for _, item in ipairs(values) do by_key[item.field.key] = item.value end
  return by_key
end

local function alarm_of(words)
  local number = ("%d.%d"):format(words[1], words[2])
  return number, T.alarms[number] or T.groups[words[1]] or "unknown alarm group"
end

local function status_name(words) return T.statuses[words[0]] or ("undocumented status 0x%04X"):format(words[0]) end

local function summary_of(words, tvb, is_answer)
  if is_answer then
    if words[0] ~= T.status.abnormal then return status_name(words) end
    return ("abnormal end, %s %s"):format(alarm_of(words))
  end
  if words[0] == 0 then
    for word = 1, T.command_words - 1 do
      if words[word] ~= 0 then return "data of the next command" end
    end
  end
  local row = row_of(words)
  if not row then return ("unknown command 0x%04X"):format(words[0]) end
  local text = row.id
  for _, item in ipairs(values_of(row.request, tvb)) do
    if item.value ~= 0 then text = text .. " " .. item.field.key .. "=" .. show(item.field, item.value) end
  end
  return text
end

local function words_line(words, tvb, is_answer)
  local last, texts = 0, {}
  for word = 0, T.command_words - 1 do
    texts[word + 1] = ("%04X"):format(words[word])
    if words[word] ~= 0 then last = word end
  end
  return (is_answer and "WO " or "WI ") .. table.concat(texts, " ", 1, last + 1) .. "  # " .. summary_of(words, tvb, is_answer)
end

-- What the image changes, compared with the image before it, and the command to which an answer belongs.
local function packet_of(number, words, tvb, is_answer, name)
  local id = number .. (is_answer and "out" or "in")
  local packet = packets[id]
  if packet then return packet end
  packet = { changes = {}, number = number, words = words }
  local link = links[name] or {}
  links[name] = link
  local before = link[is_answer]
  local is_new = is_answer and not before
  for word = 0, T.command_words - 1 do is_new = is_new or words[word] ~= (before or { [word] = 0 })[word] end
  if is_new then
    packet.changes[1] = words_line(words, tvb, is_answer)
    if not is_answer and words[0] ~= 0 and (not link.command or words[0] ~= (before and before[0] or 0)) then
      local row = row_of(words)
      packet.values = row and numbers(values_of(row.request, tvb)) or {}
      link.command = packet
    end
  end
  for _, signal in ipairs(is_answer and T.outputs or T.inputs) do
    local on = bit_of(words[signal.word], signal.bit)
    if on ~= (before and bit_of(before[signal.word], signal.bit) or false) then
      packet.changes[#packet.changes + 1] = signal.signal .. (on and " on" or " off") ..
          (signal.text and "  # " .. signal.text or "")
    end
  end
  if is_answer and words[0] ~= T.status.ready then
    packet.command = link.command
    if link.command then link.command.answer = link.command.answer or number end
  end
  link[is_answer] = words
  packets[id] = packet
  return packet
end

-- Adds the fields that the words use.
local function add_values(tree, tvb, layout, context)
  for _, item in ipairs(values_of(layout, tvb, context)) do
    local field = item.field
    local meaning = (show(field, item.value) .. " " .. field.symbol):match("^(.-) *$")
    tree:add(F[field.filter], tvb:range(field.word * 2, field.words * 2), item.value)
        :set_text(field.name .. ": " .. meaning)
  end
end

local function add_command(tree, tvb, packet)
  local words, row = packet.words, row_of(packet.words)
  tree:add(F.command, tvb:range(0, 2), words[0] % 0x1000)
  add_generated(tree, F.response_in, packet.answer)
  if not row then return problem(tree, ("0x%04X is not a remote command code"):format(words[0])) end
  add_values(tree, tvb, row.request)
  add_generated(tree, F.risk, row.risk)
  add_generated(tree, F.section, row.section)
end

local function add_answer(tree, tvb, packet)
  local words = packet.words
  tree:add(F.status, tvb:range(0, 2), words[0])
  if not T.statuses[words[0]] then problem(tree, status_name(words)) end
  local is_stop = false
  if words[0] == T.status.abnormal then
    local number, text = alarm_of(words)
    tree:add(F.alarm_group, tvb:range(2, 2), words[1])
    tree:add(F.alarm_category, tvb:range(4, 2), words[2]):set_text("alarm category: " .. number .. ": " .. text)
    tree:add(F.alarm, tvb:range(2, 4), number):set_text("alarm: " .. number .. " " .. text)
    is_stop = number == T.stop_input
  end
  local row = packet.command and row_of(packet.command.words)
  if not row then return end
  add_generated(tree, F.request_in, packet.command.number)
  add_generated(tree, F.command, packet.command.words[0] % 0x1000)
  local context, status = packet.command.values, words[0]
  if status == T.status.normal or status == T.status.abnormal and is_stop and row.is_jog or
      status == T.status.running and context[row.continuous] == 1 then
    add_values(tree, tvb, row.answer, context)
  end
end

-- Adds an image; `bus` is its fieldbus, and `name` its controller.
local function add_image(tvb, pinfo, root, bus, is_answer, name)
  local len = tvb:len()
  if len ~= T.signals_len and len < T.image_len then return end
  local bytes = tvb:range(0, len == T.signals_len and len or T.image_len):raw()
  local packet = packet_of(pinfo.number, words_of(bytes), tvb, is_answer, bus .. name)
  local tree = root:add(proto, tvb:range(0, #bytes))
  add_generated(tree, F.bus, bus)
  tree:append_text((is_answer and ", from " or ", to ") .. "the controller")
  local signals_at = 0
  if len >= T.image_len then
    signals_at = T.command_words
    tree:add(F.words, tvb:range(0, T.command_words * 2))
    if is_answer then
      add_answer(tree, tvb, packet)
    elseif packet.words[0] ~= 0 then
      add_command(tree, tvb, packet)
    end
  end
  for word = T.command_words, T.command_words + (#bytes / 2 - signals_at) - 1 do
    local at = (word - T.command_words + signals_at) * 2
    tree:add_le(F[(is_answer and "wo" or "wi") .. word], tvb:range(at, 2))
  end
  for _, signal in ipairs(is_answer and T.outputs or T.inputs) do
    local at = (signal.word - T.command_words + signals_at) * 2
    local on = bit_of(packet.words[signal.word], signal.bit)
    if signal.key and at + 2 <= #bytes then
      tree:add(F[signal.key], tvb:range(at, 2), on)
          :set_text(signal.signal .. (on and " on: " or " off: ") .. signal.text)
    end
  end
  if #packet.changes > 0 then
    local changes = table.concat(packet.changes, "; ")
    pinfo.cols.info:prepend(changes .. " | ")
    tree:append_text(": " .. changes)
  end
end

local udp_payload = field_of("udp.payload")
local cip_service, cip_data = field_of("cip.service"), field_of("cip.data")
local cip_class, cip_instance = field_of("cip.class"), field_of("cip.instance")
local can_id, can_len = field_of("can.id"), field_of("can.len")
local io_object, io_status, io_type =
  field_of("pn_io.io_data_object"), field_of("pn_io.ioxs"), field_of("pn_io.frame_info.type")

-- EtherNet/IP, class 1: two items, of which the second has the image, after a count and perhaps a run/idle header.
local function ethernet_ip(pinfo, root)
  local payload = udp_payload()
  local tvb = payload and payload.range:tvb()
  if tvb and tvb:len() >= 18 and tvb:range(0, 2):le_uint() == 2 and tvb:range(2, 4):le_uint() == 0x00088002 and
      tvb:range(14, 2):le_uint() == 0x00B1 then
    local len = tvb:range(16, 2):le_uint() - 2
    if tvb:len() < 20 + len then return end
    if len == T.image_len then
      add_image(tvb:range(20, len):tvb(), pinfo, root, "EtherNet/IP", true, tostring(pinfo.src))
    elseif len == T.image_len + 4 then
      add_image(tvb:range(24, len - 4):tvb(), pinfo, root, "EtherNet/IP", false, tostring(pinfo.dst))
    end
  end
  -- An explicit message: the answer to Get_Attribute_Single of an assembly, or Set_Attribute_Single. The assembly of
  -- outputs has the image to the controller.
  local service, data, class, instance = cip_service(), cip_data(), cip_class(), cip_instance()
  if service and data and class and instance and class.value == 4 and data.len == T.image_len then
    local tvb, is_answer = data.range:tvb(), instance.value ~= T.output_assembly
    if service.value == 0x8E then
      add_image(tvb, pinfo, root, "CIP message", is_answer, tostring(pinfo.src))
    elseif service.value == 0x10 then
      add_image(tvb, pinfo, root, "CIP message", false, tostring(pinfo.dst))
    end
  end
end

-- PROFINET: the data of the submodules in their order, if Wireshark has seen the Connect call. A status byte follows the
-- data of each.
local function profinet(tvb, pinfo, root)
  local kind = io_type()
  if not kind then return end
  local statuses, bytes, first, is_contiguous = { io_status() }, "", nil, true
  for _, object in ipairs({ io_object() }) do
    local status
    for _, candidate in ipairs(statuses) do
      if candidate.offset >= object.offset and (not status or candidate.offset < status.offset) then status = candidate end
    end
    if status and status.offset > object.offset and status.offset < tvb:len() then
      if status.value < 0x80 then return end
      is_contiguous = first == nil
      first = first or object.offset
      bytes = bytes .. tvb:range(object.offset, status.offset - object.offset):raw()
    end
  end
  if not first then return end
  local is_answer = tostring(kind.value):find("^Response") ~= nil
  local image = is_contiguous and tvb:range(first, #bytes):tvb() or new_tvb(bytes, "Image")
  add_image(image, pinfo, root, "PROFINET", is_answer, tostring(is_answer and pinfo.dl_src or pinfo.dl_dst))
end

-- DeviceNet: polls and their answers. A whole image comes in fragments.
local function devicenet(tvb, pinfo, root)
  local id, size = can_id(), can_len()
  if not id or not size or id.value >= 0x600 then return end
  local is_answer = id.value >= 0x3C0 and id.value < 0x400
  if not is_answer and (id.value < 0x400 or id.value % 8 ~= 5) then return end
  local mac = is_answer and id.value % 64 or math.floor(id.value / 8) % 64
  local at = size.offset + 4
  if size.value == 0 or at + size.value > tvb:len() then return end
  local data = tvb:range(at, size.value)
  local key = pinfo.number .. "image"
  local image = packets[key]
  if image == nil then
    local part, name = fragments[id.value], data:raw()
    image = false
    if #name == T.signals_len and not part then
      image = name
    else
      local kind, count = math.floor(name:byte() / 64), name:byte() % 64
      fragments[id.value] = nil
      if kind == 0 and count == 0 and not (part and part.next == 1) then
        fragments[id.value] = { next = 1, bytes = name:sub(2) }
      elseif part and part.next == count and kind == 1 then
        fragments[id.value] = { next = (count + 1) % 64, bytes = part.bytes .. name:sub(2) }
      elseif part and part.next == count and kind == 2 and #part.bytes + #name - 1 == T.image_len then
        image = part.bytes .. name:sub(2)
      end
    end
    packets[key] = image
  end
  if image then
    local whole = #image == T.signals_len and data:tvb() or new_tvb(image, "Image")
    add_image(whole, pinfo, root, "DeviceNet", is_answer, "MAC " .. mac)
  end
end

proto.dissector = guarded(function(tvb, pinfo, root)
  ethernet_ip(pinfo, root)
  profinet(tvb, pinfo, root)
  devicenet(tvb, pinfo, root)
end)
register_postdissector(proto)

-- PROFIBUS telegrams. Wireshark has no name for their link type.
local profibus = Proto("armctl_profibus", "PROFIBUS DP telegram")
profibus.dissector = guarded(function(tvb, pinfo, root)
  if tvb:len() < 9 then return 0 end
  local bytes = tvb:range():raw()
  local start, size, at = bytes:byte(1), nil, nil
  if start == 0x68 and bytes:byte(2) == bytes:byte(3) and bytes:byte(4) == 0x68 then
    size, at = bytes:byte(2), 5
  elseif start == 0xA2 then
    size, at = 11, 2
  else
    return 0
  end
  if #bytes ~= at + size + 1 or bytes:byte(at + size + 1) ~= 0x16 then return 0 end
  local sum = 0
  for i = at, at + size - 1 do sum = (sum + bytes:byte(i)) % 256 end
  if sum ~= bytes:byte(at + size) then return 0 end
  local to, from, control = bytes:byte(at, at + 2)
  local is_answer = control % 0x80 < 0x40
  pinfo.cols.protocol = "PROFIBUS"
  pinfo.cols.info = ("station %d to station %d"):format(from % 0x80, to % 0x80)
  root:add(profibus, tvb:range()):append_text((", station %d to station %d"):format(from % 0x80, to % 0x80))
  -- Data exchange has no service access point.
  if to < 0x80 and from < 0x80 and size > 3 then
    add_image(tvb:range(at + 2, size - 3):tvb(), pinfo, root, "PROFIBUS", is_answer, is_answer and from or to)
  end
  return #bytes
end)
DissectorTable.get("wtap_encap"):add(0, profibus)

-- The simulator inside a command, recorded by armctl.
line_dissectors[#line_dissectors + 1] = guarded(function(tvb, pinfo, root, is_sent)
  -- A line of text has no zeros.
  if tvb:len() ~= T.image_len or not tvb:range():raw():find("\0", 1, true) then return end
  pinfo.cols.protocol = "YRCX"
  add_image(tvb, pinfo, root, "simulator", not is_sent, "")
  return tvb:len()
end)
