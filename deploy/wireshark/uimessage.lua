-- UIMessage: the 16 bytes of the UIM342's converters (AA or AD, ID, control word, length, 8 data bytes, check, CC), and the instruction in it.
-- In: bytes of a line or a TCP stream; simplecan.lua gives the instruction of a CAN frame. Out: fields uimessage.* and uim342.*.
-- The check covers ID to d8 (12 bytes) or AA to d8 (13): both are taken, and named.
_G.axisgate_lines = _G.axisgate_lines or {} -- scripts share nothing but this
local axisgate_lines = _G.axisgate_lines

local frame = Proto("uimessage", "UIMessage")
local p = {
    id = ProtoField.uint8("uimessage.id", "ID"),
    check = ProtoField.uint16("uimessage.check", "Check", base.HEX),
    covers = ProtoField.string("uimessage.check.covers", "Check covers"),
}
frame.fields = { p.id, p.check, p.covers }

local body = Proto("uim342", "UIM342 instruction")
local q = {
    cw = ProtoField.uint8("uim342.cw", "Control word", base.HEX),
    ack = ProtoField.bool("uim342.ack", "Acknowledgement wanted", 8, nil, 0x80),
    length = ProtoField.uint8("uim342.length", "Data bytes"),
    name = ProtoField.string("uim342.instruction", "Instruction"),
    title = ProtoField.string("uim342.title", "Meaning"),
    form = ProtoField.string("uim342.form", "Form"),
    index = ProtoField.uint8("uim342.index", "Index"),
    value = ProtoField.int64("uim342.value", "Value"),
    data = ProtoField.bytes("uim342.data", "Data"),
    error = ProtoField.uint8("uim342.error", "Error", base.HEX),
    error_text = ProtoField.string("uim342.error.text", "Error in words"),
    about = ProtoField.string("uim342.error.about", "Error about"),
    on = ProtoField.bool("uim342.status.on", "Driver on", 8, nil, 0x04),
    stop = ProtoField.bool("uim342.status.stationary", "Stationary", 8, nil, 0x01),
    paif = ProtoField.bool("uim342.status.in_position", "In position", 8, nil, 0x02),
    tlif = ProtoField.bool("uim342.status.stall", "Stall", 8, nil, 0x08),
    lock = ProtoField.bool("uim342.status.locked", "Locked", 8, nil, 0x20),
    err = ProtoField.bool("uim342.status.error", "Error", 8, nil, 0x80),
    speed = ProtoField.int32("uim342.speed", "Speed"),
    position = ProtoField.int32("uim342.position", "Position"),
}
local fields = {}
for _, f in pairs(q) do
    fields[#fields + 1] = f
end
body.fields = fields
local e_unknown = ProtoExpert.new("uim342.unknown", "Control word that the manual does not have", expert.group.UNDECODED, expert.severity.NOTE)
body.experts = { e_unknown }

-- Control word without bit 7: name, meaning, first data byte is an index, bytes and sign of the value behind it, bytes of a SET (nil: none).
local instructions = {
    [0x01] = { "PP", "protocol parameter", true, 1, false, 2 },
    [0x06] = { "IC", "initial configuration", true, 2, false, 3 },
    [0x07] = { "IE", "notification enable", true, 2, false, 3 },
    [0x0B] = { "ML", "model", false, 0, false, nil },
    [0x0C] = { "SN", "serial number", false, 0, false, nil },
    [0x0F] = { "ER", "error report", true, 1, false, 2 },
    [0x10] = { "MT", "motor driver", true, 2, false, 3 },
    [0x11] = { "MS", "motion status", true, 1, false, 2 },
    [0x15] = { "MO", "motor driver on/off", false, 1, false, 1 },
    [0x16] = { "BG", "begin motion", false, 0, false, 0 },
    [0x17] = { "ST", "stop motion", false, 0, false, 0 },
    [0x18] = { "MF", "motion parameter group", false, 1, false, 1 },
    [0x19] = { "AC", "acceleration", false, 4, false, 4 },
    [0x1A] = { "DC", "deceleration", false, 4, false, 4 },
    [0x1B] = { "SS", "cut-in speed", false, 4, false, 4 },
    [0x1C] = { "SD", "stop deceleration", false, 4, false, 4 },
    [0x1D] = { "JV", "jog velocity", false, 4, true, 4 },
    [0x1E] = { "SP", "PTP speed", false, 4, true, 4 },
    [0x1F] = { "PR", "relative position", false, 4, true, 4 },
    [0x20] = { "PA", "absolute position", false, 4, true, 4 },
    [0x21] = { "OG", "set origin", false, 0, false, 0 },
    [0x2D] = { "BL", "backlash compensation", false, 4, false, 4 },
    [0x2E] = { "DV", "desired value", true, 4, true, nil },
    [0x34] = { "IL", "input logic", true, 2, false, 3 },
    [0x35] = { "TG", "trigger mode", true, 2, false, 3 },
    [0x37] = { "DI", "digital inputs and output", false, 4, false, 4 },
    [0x3D] = { "QE", "encoder", true, 2, false, 3 },
    [0x5A] = { "RT", "notification", false, 0, false, nil },
    [0x7E] = { "SY", "system operation", true, 0, false, 1 },
}

local function number(data, at, count, signed)
    local v, scale = 0, 1
    for k = at, math.min(at + count - 1, data:len() - 1) do
        v = v + data(k, 1):uint() * scale
        scale = scale * 256
    end
    if signed and data:len() - at >= count and v >= scale / 2 then v = v - scale end
    return v
end

local function name_of(cw, index)
    local i = instructions[bit.band(cw, 0x7F)]
    if not i then return string.format("CW %02X", bit.band(cw, 0x7F)) end
    return i[3] and string.format("%s[%d]", i[1], index) or i[1]
end

-- `cw_at`: the byte of the control word, or nil; `data`: 0 to 8 bytes, or nil for none. Returns words for the list of packets.
function axisgate_lines.uim342(cw_at, cw, data, tree, to_drive)
    local branch = data and tree:add(body, data) or tree:add(body)
    local length = data and data:len() or 0
    local i = instructions[bit.band(cw, 0x7F)]
    if cw_at then
        branch:add(q.cw, cw_at)
        branch:add(q.ack, cw_at)
    else
        branch:add(q.cw, cw)
    end
    branch:add(q.length, length):set_generated()
    if data then branch:add(q.data, data) end
    if not i then
        branch:add_proto_expert_info(e_unknown)
        return string.format("CW %02X", cw)
    end
    branch:add(q.name, i[1]):set_generated()
    branch:add(q.title, i[2]):set_generated()
    local index = i[3] and data and data(0, 1):uint() or 0
    if i[3] and data then branch:add(q.index, data(0, 1)) end
    local name = name_of(cw, index)
    local words = name
    local at = i[3] and 1 or 0
    if to_drive then
        local set = i[6] and length > at or i[6] == 0 or i[1] == "SY"
        local form = i[1] == "SY" and "do" or i[6] == 0 and "do" or set and "set" or "get"
        branch:add(q.form, form):set_generated()
        if form == "set" and i[1] == "DI" then
            words = string.format("%s=%d", name, bit.band(data(0, 1):uint(), 1))
            branch:add(q.value, data(0, 1), Int64(bit.band(data(0, 1):uint(), 1)))
        elseif form == "set" and length > at then
            local v = number(data, at, i[4], i[5])
            branch:add(q.value, data(at), Int64(v))
            words = string.format("%s=%d", name, v)
        end
    else
        branch:add(q.form, "answer"):set_generated()
        local told = (_G.axisgate_names or {}).uim342 or { errors = {}, alarms = {} }
        if i[1] == "ER" and length >= 4 then
            local code = data(1, 1):uint()
            branch:add(q.error, data(1, 1))
            if code ~= 0 then
                branch:add(q.error_text, data(1, 1), told.errors[code] or told.alarms[code] or "not named")
                branch:add(q.about, data(2), name_of(data(2, 1):uint(), length > 3 and data(3, 1):uint() or 0))
                words = string.format("error 0x%02X about %s", code, name_of(data(2, 1):uint(), data(3, 1):uint()))
            end
        elseif i[1] == "MS" and length >= 8 and index == 0 then
            branch:add(q.on, data(1, 1))
            for _, f in ipairs({ q.stop, q.paif, q.tlif, q.lock, q.err }) do
                branch:add(f, data(2, 1))
            end
            branch:add_le(q.position, data(4, 4))
            words = name .. (bit.band(data(1, 1):uint(), 4) ~= 0 and ", driver on" or ", driver off")
                .. (bit.band(data(2, 1):uint(), 1) ~= 0 and ", stationary" or ", moving")
        elseif i[1] == "MS" and length >= 8 and index == 1 then
            branch:add(q.speed, data(1, 3), data(1, 3):le_int())
            branch:add_le(q.position, data(4, 4))
            words = string.format("MS[1] speed %d, position %d", data(1, 3):le_int(), data(4, 4):le_int())
        elseif i[1] == "RT" and length > 0 then
            local code = data(0, 1):uint()
            if code == 0 and length > 1 then
                code = data(1, 1):uint()
                branch:add(q.error, data(1, 1))
                branch:add(q.error_text, data(1, 1), told.alarms[code] or "not named")
            end
            words = string.format("notification 0x%02X", code)
        elseif i[4] > 0 and length > at then
            local v = number(data, at, i[4], i[5])
            branch:add(q.value, data(at), Int64(v))
            words = string.format("%s = %d", name, v)
        end
    end
    branch:append_text(": " .. words)
    return words
end

-- CRC-16/MODBUS over data[from .. to], 1-based.
local function crc(data, from, to)
    local c = 0xFFFF
    for k = from, to do
        c = bit.bxor(c, data:byte(k))
        for _ = 1, 8 do
            c = bit.band(c, 1) ~= 0 and bit.bxor(bit.rshift(c, 1), 0xA001) or bit.rshift(c, 1)
        end
    end
    return c
end

-- What 16 bytes from `at` on prove: "ID to d8", "AA to d8", "nothing", or nil.
local function proved(data, at)
    if data:byte(at + 15) ~= 0xCC or data:byte(at + 3) > 8 then return nil end
    local told = data:byte(at + 13) + 256 * data:byte(at + 14)
    if data:byte(at) == 0xAD then return told == 0 and "nothing" or nil end
    if crc(data, at + 1, at + 12) == told then return "ID to d8" end
    if crc(data, at, at + 12) == told then return "AA to d8" end
    return nil
end

local family = { title = "UIMessage" }
axisgate_lines.uimessage = family

function family.split(data)
    local messages, at = {}, 1
    local function strange(upto)
        local last = messages[#messages]
        if last and last.junk and last.to == at - 1 then
            last.to = upto
        else
            messages[#messages + 1] = { from = at, to = upto, junk = "no UIMessage" }
        end
        at = upto + 1
    end
    while at <= #data do
        local b = data:byte(at)
        if b ~= 0xAA and b ~= 0xAD then
            strange(at)
        elseif #data - at < 15 then
            break
        else
            local covers = proved(data, at)
            if covers then
                messages[#messages + 1] = { from = at, to = at + 15, covers = covers }
                at = at + 16
            else
                strange(at)
            end
        end
    end
    return messages, at
end

function family.sure(data)
    for at = 1, #data - 15 do
        local b = data:byte(at)
        if (b == 0xAA or b == 0xAD) and proved(data, at) then return true end
    end
    return false
end

function family.show(range, m, _, tree, to_drive)
    local branch = tree:add(frame, range)
    branch:add(p.id, range(1, 1))
    branch:add_le(p.check, range(13, 2))
    branch:add(p.covers, m.covers):set_generated()
    local cw, length = range(2, 1):uint(), range(3, 1):uint()
    if to_drive == nil then to_drive = bit.band(cw, 0x80) ~= 0 or range(1, 1):uint() == 0 end
    local words = axisgate_lines.uim342(range(2, 1), cw, length > 0 and range(4, length) or nil, branch, to_drive)
    words = string.format("%s %s  %s", to_drive and "to" or "from", range(1, 1):uint() == 0 and "all" or range(1, 1):uint(), words)
    branch:append_text(", " .. words)
    return words
end

function frame.dissector(tvb, pinfo, tree) return axisgate_lines.stream("uimessage", tvb, pinfo, tree) end
DissectorTable.get("tcp.port"):add(8888, frame)
