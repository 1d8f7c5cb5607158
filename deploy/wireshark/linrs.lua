-- LinRS: the telegrams of LinMot drives: 01, ID, length, 02, sub ID, main ID, data, 04; the length tells the end, since 01, 02 and 04 occur in data.
-- In: bytes of a line, or of a serial server over TCP (Decode As). Out: fields linrs.*: requests, the default response, other answers.
-- The preference says whether two bytes of a checksum stand behind the data (parameter 2080h of the drive); they are shown, not judged.
_G.axisgate_lines = _G.axisgate_lines or {} -- scripts share nothing but this
local axisgate_lines = _G.axisgate_lines

local linrs = Proto("linrs", "LinRS")
linrs.prefs.checksum = Pref.bool("Checksum", false, "Two bytes of a checksum stand before the telegram's end")
local mains = { [0] = "response", [1] = "control word", [2] = "motion", [3] = "RAM value", [4] = "curves", [5] = "parameters", [6] = "program", [7] = "errors", [8] = "command table" }
local p = {
    id = ProtoField.uint8("linrs.id", "ID"),
    length = ProtoField.uint8("linrs.length", "Length"),
    sub = ProtoField.uint8("linrs.sub", "Sub ID", base.HEX),
    main = ProtoField.uint8("linrs.main", "Main ID", base.HEX, mains),
    data = ProtoField.bytes("linrs.data", "Data"),
    check = ProtoField.uint16("linrs.checksum", "Checksum", base.HEX),
    control = ProtoField.uint16("linrs.control_word", "Control word", base.HEX),
    header = ProtoField.uint16("linrs.motion", "Motion command", base.HEX),
    count = ProtoField.uint8("linrs.count", "Count"),
    name = ProtoField.string("linrs.motion.name", "Motion command in words"),
    upid = ProtoField.uint16("linrs.upid", "Parameter", base.HEX),
    parameter = ProtoField.string("linrs.upid.name", "Parameter in words"),
    number = ProtoField.uint16("linrs.number", "Curve or entry"),
    value = ProtoField.uint32("linrs.value", "Value"),
    communication = ProtoField.uint8("linrs.communication", "Communication", base.HEX),
    status = ProtoField.uint16("linrs.status", "Status word", base.HEX),
    state = ProtoField.uint8("linrs.state", "State"),
    state_text = ProtoField.string("linrs.state.text", "State in words"),
    sub_state = ProtoField.uint8("linrs.state.sub", "Sub state", base.HEX),
    error = ProtoField.string("linrs.error", "Error"),
    position = ProtoField.int32("linrs.position", "Position (0.1 um)"),
    bits = ProtoField.string("linrs.bits", "Bits"),
}
local fields = {}
for _, f in pairs(p) do
    fields[#fields + 1] = f
end
linrs.fields = fields

local family = { title = "LinRS" }
axisgate_lines.linrs = family

-- The bytes of the telegram at `at`; nil: none begins here; 0: more is to come.
local function whole(data, at)
    if data:byte(at) ~= 0x01 then return nil end
    local length = data:byte(at + 2)
    if not length then return 0 end
    if length < 2 or length > 63 then return nil end
    local mark = data:byte(at + 3)
    if not mark then return 0 end
    if mark ~= 0x02 then return nil end
    local size = length + 4 + (linrs.prefs.checksum and 2 or 0)
    if #data - at + 1 < size then return 0 end
    return data:byte(at + size - 1) == 0x04 and size or nil
end

function family.split(data)
    local messages, at = {}, 1
    while at <= #data do
        local size = whole(data, at)
        if size == 0 then break end
        if size then
            messages[#messages + 1] = { from = at, to = at + size - 1 }
            at = at + size
        else
            local last = messages[#messages]
            if last and last.junk and last.to == at - 1 then
                last.to = at
            else
                messages[#messages + 1] = { from = at, to = at, junk = "no telegram" }
            end
            at = at + 1
        end
    end
    return messages, at
end

function family.sure(data)
    for at = 1, #data - 6 do
        local size = whole(data, at)
        if size and size > 0 then return true end
    end
    return false
end

local function bits_of(list, word)
    local s = {}
    for k = 0, 15 do
        if bit.band(bit.rshift(word, k), 1) ~= 0 and list[k] then s[#s + 1] = list[k] end
    end
    return #s > 0 and table.concat(s, " ") or "none"
end

local empty = { motions = {}, parameters = {}, states = {}, errors = {}, status_bits = {}, control_bits = {} }

local function show_parameter(branch, data, names)
    local upid = data(0, 2):le_uint()
    branch:add_le(p.upid, data(0, 2))
    if names.parameters[upid] then branch:add(p.parameter, names.parameters[upid]):set_generated() end
    if data:len() >= 6 then branch:add_le(p.value, data(2, 4)) end
    return string.format("%04Xh%s", upid, names.parameters[upid] and " (" .. names.parameters[upid] .. ")" or "")
end

local function show_request(branch, main, sub, data, names)
    local size = data and data:len() or 0
    if main == 1 and size >= 2 then
        local word = data(0, 2):le_uint()
        branch:add_le(p.control, data(0, 2))
        branch:add(p.bits, bits_of(names.control_bits, word)):set_generated()
        return string.format("control word %04Xh", word)
    elseif main == 2 and size >= 2 then
        local header = data(0, 2):le_uint()
        local name = names.motions[bit.band(header, 0xFFF0)]
        branch:add_le(p.header, data(0, 2))
        branch:add(p.count, data(0, 1), bit.band(header, 0x0F))
        branch:add(p.name, name or "unknown"):set_generated()
        return string.format("%s, count %d", name or string.format("motion command %04Xh", header), bit.band(header, 0x0F))
    elseif (main == 3 or main == 5) and size >= 2 then
        return string.format("%s %02Xh of %s", mains[main], sub, show_parameter(branch, data, names))
    elseif (main == 4 or main == 8) and size >= 2 then
        branch:add_le(p.number, data(0, 2))
        return string.format("%s %02Xh, %d", mains[main], sub, data(0, 2):le_uint())
    end
    return string.format("%s %02Xh", mains[main] or string.format("main ID %02Xh", main), sub)
end

local function show_answer(branch, sub, data, names)
    local size = data and data:len() or 0
    if size > 0 then branch:add(p.communication, data(0, 1)) end
    if sub == 0 and size >= 9 then
        local status, state = data(1, 2):le_uint(), data(4, 1):uint()
        branch:add_le(p.status, data(1, 2))
        branch:add(p.bits, bits_of(names.status_bits, status)):set_generated()
        branch:add(p.state, data(4, 1))
        branch:add(p.state_text, names.states[state] or "state " .. state):set_generated()
        branch:add(p.sub_state, data(3, 1))
        local where = names.states[state] or "state " .. state
        if state == 8 then
            branch:add(p.count, data(3, 1), bit.band(data(3, 1):uint(), 0x0F))
        elseif state == 3 or state == 4 then
            branch:add(p.error, names.errors[data(3, 1):uint()] or "not named"):set_generated()
            where = where .. " " .. (names.errors[data(3, 1):uint()] or "")
        end
        branch:add_le(p.position, data(5, 4))
        if size == 13 then branch:add_le(p.value, data(9, 4)) end
        return string.format("%s, position %.4f mm", where, data(5, 4):le_int() / 10000)
    elseif size == 7 then
        if sub >= 0x50 and sub < 0x60 then return "parameter answer of " .. show_parameter(branch, data(1), names) end
        branch:add_le(p.number, data(1, 2))
        branch:add_le(p.value, data(3, 4))
    end
    return string.format("answer %02Xh", sub)
end

function family.show(range, _, _, tree, to_drive)
    local names = (_G.axisgate_names or {}).linmot or empty
    local branch = tree:add(linrs, range)
    local length = range(2, 1):uint()
    branch:add(p.id, range(1, 1))
    branch:add(p.length, range(2, 1))
    branch:add(p.sub, range(4, 1))
    local main = length > 2 and range(5, 1):uint() or 0
    if length > 2 then branch:add(p.main, range(5, 1)) end
    local data = length > 3 and range(6, length - 3) or nil
    if data then branch:add(p.data, data) end
    if range:len() == length + 6 then branch:add_le(p.check, range(length + 3, 2)) end
    if to_drive == nil then to_drive = main ~= 0 or not data end
    local words
    if to_drive then
        words = show_request(branch, main, range(4, 1):uint(), data, names)
    else
        words = show_answer(branch, range(4, 1):uint(), data, names)
    end
    words = string.format("%s %d  %s", to_drive and "to" or "from", range(1, 1):uint(), words)
    branch:append_text(", " .. words)
    return words
end

function linrs.dissector(tvb, pinfo, tree) return axisgate_lines.stream("linrs", tvb, pinfo, tree) end
DissectorTable.get("tcp.port"):add_for_decode_as(linrs)
