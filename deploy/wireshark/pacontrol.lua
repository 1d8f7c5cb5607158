-- PA-CONTROL: SOH STX text ETX check EOT on the serial port, and the poll, a lone EOT.
-- In: bytes of a line, or of a serial server over TCP (Decode As). Out: fields pacontrol.*: requests and acknowledgements in words.
-- The check is the XOR of the text in requests, of text and ETX in acknowledgements; 0 is "not used" in both.
_G.axisgate_lines = _G.axisgate_lines or {} -- scripts share nothing but this
local axisgate_lines = _G.axisgate_lines

local pa = Proto("pacontrol", "PA-CONTROL")
local p = {
    poll = ProtoField.bool("pacontrol.poll", "Poll"),
    text = ProtoField.string("pacontrol.text", "Text"),
    command = ProtoField.uint16("pacontrol.command", "Command", base.HEX),
    name = ProtoField.string("pacontrol.command.name", "Command in words"),
    parameter = ProtoField.uint32("pacontrol.parameter", "Parameter"),
    kind = ProtoField.uint8("pacontrol.type", "Type of the data", base.DEC, { [0] = "integer", [1] = "real" }),
    data = ProtoField.string("pacontrol.data", "Data"),
    quit = ProtoField.uint16("pacontrol.quit", "Command error"),
    quit_text = ProtoField.string("pacontrol.quit.text", "Command error in words"),
    ended = ProtoField.bool("pacontrol.end_of_processing", "End of processing"),
    status = ProtoField.uint16("pacontrol.status", "Operating status"),
    status_text = ProtoField.string("pacontrol.status.text", "Operating status in words"),
    error = ProtoField.uint16("pacontrol.error", "PA-CONTROL error"),
    error_text = ProtoField.string("pacontrol.error.text", "PA-CONTROL error in words"),
    check = ProtoField.string("pacontrol.check", "Check"),
    form = ProtoField.string("pacontrol.check.form", "Check is"),
}
local fields = {}
for _, f in pairs(p) do
    fields[#fields + 1] = f
end
pa.fields = fields
local e_check = ProtoExpert.new("pacontrol.check.wrong", "Check is wrong", expert.group.CHECKSUM, expert.severity.WARN)
local e_text = ProtoExpert.new("pacontrol.unknown", "Neither a request nor an acknowledgement", expert.group.UNDECODED, expert.severity.WARN)
pa.experts = { e_check, e_text }

local family = { title = "PA-CONTROL" }
axisgate_lines.pacontrol = family
local longest = 127

function family.split(data)
    local messages, at = {}, 1
    local function strange(upto, why)
        local last = messages[#messages]
        if last and last.junk == why and last.to == at - 1 then
            last.to = upto
        else
            messages[#messages + 1] = { from = at, to = upto, junk = why }
        end
        at = upto + 1
    end
    while at <= #data do
        local b = data:byte(at)
        if b == 0x04 then
            messages[#messages + 1] = { from = at, to = at, poll = true }
            at = at + 1
        elseif b ~= 0x01 then
            strange(at, "bytes outside a frame")
        else
            local text, check, eot = data:match("^\1\2([\32-\127]*)\3(%d?%d?%d?)()\4", at)
            if text and #text <= 120 then
                messages[#messages + 1] = { from = at, to = eot, text = text, check = check }
                at = eot + 1
            else
                -- Whole as far as it goes: more is to come. Else what is here begins no frame; another SOH begins anew.
                local tail = data:sub(at)
                if #tail <= longest and (tail:match("^\1\2?$") or tail:match("^\1\2[\32-\127]*$") or tail:match("^\1\2[\32-\127]*\3%d?%d?%d?$")) then break end
                local again = data:find("\1", at + 1, true)
                local stop = data:find("\4", at + 1, true)
                local upto = #data
                if stop then upto = stop end
                if again and again - 1 < upto then upto = again - 1 end
                strange(upto, "no frame")
            end
        end
    end
    return messages, at
end

function family.sure(data) return data:find("\1\2[\32-\127]+\3%d+\4") ~= nil end

local function xor(text)
    local c = 0
    for k = 1, #text do
        c = bit.bxor(c, text:byte(k))
    end
    return c
end

-- "good", "not used", "as for the other direction", "wrong"
local function judge(text, check, request)
    local plain = xor(text)
    local right, other = plain, bit.bxor(plain, 3)
    if not request then right, other = other, right end
    local v = tonumber(check)
    if v == right then return "good" end
    if v == 0 then return "not used" end
    if v == other then return "as for the other direction" end
    return "wrong"
end

function family.show(range, m, _, tree, to_drive)
    local branch = tree:add(pa, range)
    if m.poll then
        branch:add(p.poll, range, true)
        branch:append_text(", poll")
        return "poll"
    end
    local names = (_G.axisgate_names or {}).pacontrol or { commands = {}, quits = {}, errors = {}, states = {} }
    local whole = range(2, #m.text)
    branch:add(p.text, whole)
    local words
    local code, parameter, kind, data = m.text:match("^(%x%x%x%x);(%d+);([01]);(.*)$")
    local quit, ended, status, err, r_kind, r_data = m.text:match("^(%d+);([01]);(%d+);(%d+);([01]);(.*)$")
    local request = to_drive
    if request == nil then request = code ~= nil end
    if request and code then
        local number = tonumber(code, 16)
        branch:add(p.command, whole, number)
        branch:add(p.name, names.commands[number] or "unknown command"):set_generated()
        branch:add(p.parameter, whole, tonumber(parameter))
        branch:add(p.kind, whole, tonumber(kind))
        branch:add(p.data, whole, data)
        words = string.format("%s %s %s = %s", code, names.commands[number] or "unknown command", parameter, data)
    elseif not request and quit then
        local q, s, e = tonumber(quit), tonumber(status), tonumber(err)
        branch:add(p.quit, whole, q)
        if q ~= 0 then branch:add(p.quit_text, names.quits[q] or "not named"):set_generated() end
        branch:add(p.ended, whole, ended == "1")
        branch:add(p.status, whole, s)
        branch:add(p.status_text, names.states[s] or "no meaning given"):set_generated()
        branch:add(p.error, whole, e)
        if e ~= 0 then branch:add(p.error_text, names.errors[e] or "see the control's manual"):set_generated() end
        branch:add(p.kind, whole, tonumber(r_kind))
        branch:add(p.data, whole, r_data)
        words = (q ~= 0 and "command error " .. quit or ended == "1" and "done" or "being processed") .. ", " .. r_data .. "; status " .. status
            .. (e ~= 0 and "; E" .. err or "")
    else
        branch:add_proto_expert_info(e_text)
        words = m.text
    end
    local form = judge(m.text, m.check, request)
    if #m.check > 0 then branch:add(p.check, range(3 + #m.text, #m.check)) end
    branch:add(p.form, form):set_generated()
    if form == "wrong" then branch:add_proto_expert_info(e_check) end
    words = words .. (form == "wrong" and " [check wrong]" or "")
    branch:append_text(", " .. words)
    return words
end

function pa.dissector(tvb, pinfo, tree) return axisgate_lines.stream("pacontrol", tvb, pinfo, tree) end
DissectorTable.get("tcp.port"):add_for_decode_as(pa)
