local proto, F, problem, guarded = protocol("armctl_toyo", "Toyo host communication", T.fields)

-- End that is the controller, last request of each connection, what is known of each line of each packet, and
-- unfinished lines.
local controllers, requests, lines, unfinished
function proto.init() controllers, requests, lines, unfinished = {}, {}, {}, {} end

local function row_of(word) return T.rows[word == "HTSK" and "CTSK" or word] end

local function word_of(text) return text:gsub("^@", ""):match("^[^ ]*") end

local function verdict_of(text) return text:match("^@(OK) *$") or text:match("^@(NG) *$") end

-- Number of a text that has the exact form, in units of its last decimal.
local function number_of(number, own)
  local function fits(whole, decimals)
    local form = "^" .. (number.signed and "[+-]" or "") .. ("%d"):rep(whole) .. (decimals > 0 and "%." or "") ..
        ("%d"):rep(decimals) .. "$"
    return own:find(form) and tonumber((own:gsub("%.", "")))
  end
  local value = fits(number.whole, number.decimals)
  if value then return value * 10 ^ number.spare end
  return number.spare > 0 and fits(number.whole - number.spare, number.decimals + number.spare)
end

-- Takes a value at the start of a text. Returns its length, meaning, value for filters, and whether it is out of range.
local function take(field, text)
  local number = field.number
  if number then
    local width = (number.signed and 1 or 0) + number.whole + (number.decimals > 0 and number.decimals + 1 or 0)
    local own = text:sub(1, width)
    if #own < width then return end
    if field.starred and own:find("^%*+$") then return width, ("*"):rep(number.whole) end
    local units = number_of(number, own)
    if not units then return end
    local step = 10 ^ number.spare
    local shown = units % step == 0 and decimal(units / step, number) or
        decimal(units, { decimals = number.decimals + number.spare })
    local is_out = units < number.least or units > number.most or units % step ~= 0
    return width, shown .. field.unit, units / 10 ^ (number.decimals + number.spare), is_out
  end
  if field.choices then
    local best
    for _, choice in ipairs(field.choices) do
      if text:sub(1, #choice[1]) == choice[1] and (not best or #choice[1] > #best[1]) then best = choice end
    end
    if best then return #best[1], best[2], best[1] end
    return
  end
  local form, own = field.form, nil
  if form == "hex" then
    own = text:sub(1, 2)
    if field.starred and own == "**" then return 2, own end
    if own:find("^%x%x$") then return 2, own:upper(), tonumber(own, 16) end
    return
  end
  if form == "bits" or form == "mask" then
    own = text:match(form == "bits" and "^" .. ("[01]"):rep(8) or "^" .. ("[01.]"):rep(8))
  else
    own = form == "token" and text:match("^[^ ]+") or form == "text" and text
  end
  if own then return #own, own:match("^ *(.-) *$"), own end
end

-- Position after words. A blank matches one or more blanks.
local function skip(words, text, at)
  for i = 1, #words do
    local char = words:sub(i, i)
    if text:sub(at, at) ~= char then return nil, at end
    at = at + 1
    if char == " " then at = text:match("^ *()", at) end
  end
  return at
end

-- Values of a text in a layout, up to the first that does not fit; then also the problem and its position.
local function scan(layout, text)
  local at, values = text:match("^ *()"), {}
  for i, words in ipairs(layout.words) do
    local next_at, wrong_at = skip(words, text, at)
    if not next_at then return values, "'" .. words .. "' is expected", wrong_at end
    at = next_at
    local field = layout.fields[i]
    if not field then break end
    local len, meaning, value, is_out = take(field, text:sub(at))
    if not len then return values, field.name .. ": not in its form", at end
    values[#values + 1] = { field = field, meaning = meaning, value = value, is_out = is_out, at = at, len = len }
    at = at + len
  end
  local rest = text:sub(at):match("^(.-) *$")
  if rest ~= "" then return values, "unexpected text '" .. rest .. "'", at end
  return values
end

local function parameter_of(text)
  for _, row in ipairs(T.parameters) do
    local given, fits = text:gmatch("[^ ]+"), true
    for _, word in ipairs(row.words) do
      local own = given() or ""
      local is_key = (word:find("=$") or word == "V" or word == "A" or word == "LIM") and own:sub(1, #word) == word
      fits = fits and (own == word or is_key)
    end
    if fits then return row end
  end
end

-- Values of the block by name, by the first form that fits. Contents of a block are not values.
local function block_values(row, forms, text)
  for _, form in ipairs(forms) do
    local values, wrong = scan(form, row.word .. text:gsub("^@", ""):sub(#row.word + 1))
    if not wrong then
      local by_name = {}
      for _, value in ipairs(values) do
        if value.field.form ~= "text" then by_name[value.field.name] = value.meaning end
      end
      return by_name
    end
  end
end

-- What a line contains, by one form of its command: items of name, meaning and place; then the problem and its position.
local function read_form(row, form, text, is_answer)
  local start = text:sub(1, 1) == "@" and 1 or 0
  local items = { { key = "command", name = "command", meaning = row.about, value = row.word, at = start + 1, len = #row.word } }
  local found, trouble
  local function add(values, shift, page)
    for _, value in ipairs(values) do
      local field, meaning = value.field, value.meaning
      if row.word == "STAS" and field.name == "st1" then
        meaning = (T.pages[page] or {})[value.value] or "no bit is set"
      elseif row.word == "EHTR" and field.name == "error" and value.value then
        meaning = T.errors[value.value]
      elseif row.word == "EHTR" and value.value == nil then
        meaning = "the power was switched off"
      end
      if value.is_out then
        meaning = meaning .. ", out of range"
        if not is_answer then found = found or field.name .. ": out of range" end
      end
      items[#items + 1] = { key = field.key, name = field.name, meaning = meaning, value = value.value,
        at = value.at + shift, len = value.len }
    end
  end
  local values, wrong, wrong_at = scan(form, row.word .. text:sub(start + #row.word + 1))
  local record, page
  for _, value in ipairs(values) do
    if value.field.name == "record" then record = value.value end
    if value.field.name == "page" then page = value.value end
  end
  for _, value in ipairs(values) do
    local name = value.field.name
    if value.field.form == "text" and (name == "body" or name == "key" or name == "text") then
      local body, layout = text:sub(value.at + start), nil
      local word = body:match("^[^ ]*")
      if row.word == "WPAR" or row.word == "RPAR" then
        local parameter = parameter_of(body)
        if not parameter then return items, "unknown parameter '" .. word .. "'", value.at + start end
        items[#items + 1] = { key = "parameter", name = "parameter", meaning = parameter.name, value = parameter.id,
          at = value.at + start, len = math.min(#parameter.id, #body) }
        layout = row.word == "RPAR" and not is_answer and parameter.key or parameter.layout
      elseif row.word == "WSTX" or row.word == "RSTX" then
        local instruction = T.instructions[word]
        if not instruction then return items, "unknown instruction '" .. word .. "'", value.at + start end
        items[#items + 1] = { key = "instruction", name = "instruction", meaning = instruction.about, value = word,
          at = value.at + start, len = #word }
        layout = instruction.layout
      else
        layout = T.records[record]
        if not layout then return items, "unknown record", value.at + start end
      end
      local inner, inner_wrong, inner_at = scan(layout, body)
      add(inner, value.at + start - 1, page)
      if inner_wrong then return items, inner_wrong, inner_at + value.at + start - 1 end
    else
      add({ value }, start, page)
    end
  end
  if wrong then return items, wrong, wrong_at + start end
  return items, found
end

-- A line by the form that fits, or else by the form that fits the longest part of it. Returns also how far it fits.
local function read_line(row, text, is_answer)
  local best, best_problem, best_at
  for _, form in ipairs(is_answer and row.answers or row.requests) do
    local items, wrong, at = read_form(row, form, text, is_answer)
    if not at then return items, wrong, math.huge end
    if not best or at > best_at then best, best_problem, best_at = items, wrong, at end
  end
  if best then return best, best_problem, best_at end
  local items = read_form(row, { words = { row.word }, fields = {} }, text, is_answer)
  return items, "the answer to " .. row.word .. " must be @OK or @NG", 0
end

local function looks_like_answer(text)
  if verdict_of(text) then return true end
  local row = row_of(word_of(text))
  if not row then return false end
  if row.word == "MERP" and text:find(" $") then return true end
  local _, _, request_at = read_line(row, text, false)
  local _, _, answer_at = read_line(row, text, true)
  return answer_at > request_at
end

-- The problem of a line as a whole.
local function damage_of(text)
  if #text > T.max_len then return ("the block has %d characters; the maximum is %d"):format(#text, T.max_len) end
  local at = text:find("[^ -~]")
  if at then return ("a character at column %d is not allowed"):format(at) end
  if text:sub(1, 1) ~= "@" then return "a block must begin with @" end
  if not row_of(word_of(text)) then return "unknown command '" .. word_of(text) .. "'" end
end

local function describe(text, line)
  local request = line.is_answer and line.request
  local verdict = line.is_answer and verdict_of(text)
  if verdict then
    local what = verdict == "OK" and "done" or "refused"
    local items = { { key = "verdict", name = "verdict", meaning = what, value = verdict, at = 2, len = 2 } }
    local wrong = request and verdict == "OK" and #request.row.answers > 0 and "@OK does not answer this request"
    return (request and "answer to " .. request.row.word or "answer") .. ": " .. what, items, wrong
  end
  local row, what = row_of(word_of(text)), line.is_answer and "answer" or "request"
  if not row then return what .. ", unknown", {}, damage_of(text) end
  local items, wrong = read_line(row, text, line.is_answer)
  local other
  if request and request.row ~= row then
    other = "it answers another request: " .. row.word .. ", not " .. request.row.word
  elseif request and not (row.word == "RSTX" and tonumber(request.values.step) == 0) then
    for name, meaning in pairs(block_values(row, row.answers, text) or {}) do
      local asked = request.values[name]
      if asked and asked ~= meaning then other = ("it answers another request: %s is %s, not %s"):format(name, meaning, asked) end
    end
  end
  return what .. ": " .. row.word .. ", " .. row.about, items, damage_of(text) or other or wrong
end

-- What the lines before this one tell about it: its sender, and the request that it answers.
local function line_of(id, pinfo, text, connection, from, to, is_answer)
  local line = lines[id]
  if line then return line end
  if is_answer == nil then
    -- The first line shows the ends.
    controllers[connection] = controllers[connection] or (looks_like_answer(text) and from or to)
    is_answer = controllers[connection] == from
  end
  line = { is_answer = is_answer, number = pinfo.number }
  if is_answer then
    line.request = requests[connection]
    requests[connection] = nil
    if line.request then line.request.line.answer = pinfo.number end
  elseif not damage_of(text) then
    local row = row_of(word_of(text))
    local values = block_values(row, row.requests, text)
    requests[connection] = values and { row = row, values = values, line = line } or nil
  else
    requests[connection] = nil
  end
  lines[id] = line
  return line
end

-- Adds a line that starts at `at` in the bytes. Returns its summary.
local function add_line(tvb, at, text, line, root)
  local tree = root:add(proto, tvb:range(at, #text))
  local title, items, wrong = describe(text, line)
  local meanings = {}
  for i, item in ipairs(items) do
    local range = tvb:range(at + item.at - 1, math.min(item.len, #text - item.at + 1))
    local words = item.name .. ": " .. item.meaning
    if item.value == nil then tree:add(range, words) else tree:add(F[item.key], range, item.value):set_text(words) end
    if i > 1 then meanings[#meanings + 1] = item.name .. " " .. item.meaning end
  end
  local row = line.request and line.request.row or row_of(word_of(text))
  if row then
    if line.request then add_generated(tree, F.command, row.word) end
    add_generated(tree, F.section, row.section)
    add_generated(tree, F.risk, row.risk)
  end
  add_generated(tree, F.request_in, line.request and line.request.line.number)
  add_generated(tree, F.response_in, line.answer)
  local summary = title .. (#meanings > 0 and ": " .. table.concat(meanings, ", ") or "")
  if wrong then
    problem(tree, wrong)
    summary = "no valid block: " .. wrong
  end
  tree:append_text(", " .. summary)
  return text .. "  # " .. summary
end

-- Adds all lines of the bytes. Returns the number of bytes after the last line end.
local function add_lines(tvb, pinfo, root, connection, from, to, is_answer)
  local bytes, at, summaries = tvb:range():raw(), 1, {}
  while true do
    local first, last = bytes:find("\n", at, true)
    if not first then break end
    local text = bytes:sub(at, last):match("^(.-)[\r\n]*$")
    if text ~= "" then
      local id = pinfo.number .. ":" .. at
      local line = line_of(id, pinfo, text, connection, from, to, is_answer)
      summaries[#summaries + 1] = add_line(tvb, at - 1, text, line, root)
    end
    at = last + 1
  end
  if #summaries > 0 then
    pinfo.cols.protocol = "TOYO"
    pinfo.cols.info = table.concat(summaries, "; ")
  end
  return #bytes - at + 1
end

local function dissect(tvb, pinfo, root)
  local from, to = from_to(pinfo)
  local rest = add_lines(tvb, pinfo, root, from < to and from .. to or to .. from, from, to)
  -- A block is never so long.
  if rest > 0 and rest <= 4 * T.max_len and pinfo.can_desegment > 0 then
    pinfo.desegment_offset = tvb:len() - rest
    pinfo.desegment_len = DESEGMENT_ONE_MORE_SEGMENT
  end
  return tvb:len()
end

proto.dissector = guarded(dissect)
local function is_ours(tvb)
  if tvb:len() == 0 then return false end
  local text = tvb:range():raw():match("^[^\r\n]*")
  return verdict_of(text) ~= nil or text:sub(1, 1) == "@" and row_of(word_of(text)) ~= nil
end
proto:register_heuristic("tcp", function(tvb, pinfo, root)
  if not is_ours(tvb) then return false end
  pinfo.conversation = proto
  proto.dissector(tvb, pinfo, root)
  return true
end)

-- A line on a serial line can come in several packets.
line_dissectors[#line_dissectors + 1] = guarded(function(tvb, pinfo, root, is_sent)
  local before = lines[pinfo.number]
  if not before then
    before = unfinished[is_sent] or ""
    if before == "" and not is_ours(tvb) and tvb:range(0, 1):string() ~= "@" then return end
    lines[pinfo.number] = before
    unfinished[is_sent] = (before .. tvb:range():raw()):match("[^\n]*$"):sub(-4 * T.max_len)
  end
  if before ~= "" then
    tvb = new_tvb(before .. tvb:range():raw(), "Line")
  end
  add_lines(tvb, pinfo, root, "line", "", "", not is_sent)
  return tvb:len()
end)
