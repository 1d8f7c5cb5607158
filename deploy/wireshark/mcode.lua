-- MCode: lines of text of the Lexium drives, with a drive's name before them in party mode and a checksum behind them where CK says so.
-- In: bytes of a line, or of MCode/TCP and UDP (port 503). Out: fields mcode.*, a message for each line, prompt and control character.
-- Never judges a command: which words there are, and what they mean, the generated names say.
_G.axisgate_lines = _G.axisgate_lines or {} -- scripts share nothing but this
local axisgate_lines = _G.axisgate_lines

local mcode = Proto("mcode", "Lexium MCode")
local p = {
    drive = ProtoField.string("mcode.drive", "To the drive"),
    text = ProtoField.string("mcode.text", "Line"),
    word = ProtoField.string("mcode.word", "Word"),
    meaning = ProtoField.string("mcode.meaning", "Meaning"),
    check = ProtoField.uint8("mcode.checksum", "Checksum", base.HEX),
    good = ProtoField.bool("mcode.checksum.good", "Checksum good"),
    ended = ProtoField.string("mcode.end", "Ended by"),
    control = ProtoField.string("mcode.control", "Control"),
    prompt = ProtoField.bool("mcode.prompt.error", "Prompt tells of an error"),
}
local fields = {}
for _, f in pairs(p) do
    fields[#fields + 1] = f
end
mcode.fields = fields
local e_check = ProtoExpert.new("mcode.checksum.wrong", "Checksum is wrong", expert.group.CHECKSUM, expert.severity.WARN)
local e_strange = ProtoExpert.new("mcode.strange", "Bytes that are no MCode", expert.group.PROTOCOL, expert.severity.WARN)
mcode.experts = { e_check, e_strange }

-- What is no printable character, as <XX>.
local function visible(text)
    return (text:gsub("[^\32-\126]", function(c) return string.format("<%02X>", c:byte()) end))
end

local controls = { [0x06] = "ACK", [0x15] = "NAK", [0x1B] = "ESC", [0x05] = "CTRL+E", [0x03] = "CTRL+C" }
local meanings = { ESC = "stop at once", ["CTRL+E"] = "stop at once", ["CTRL+C"] = "reset" }

local family = { title = "MCode" }
axisgate_lines.mcode = family

function family.split(data, to_drive)
    local messages, from = {}, 1
    for at = 1, #data do
        local b = data:byte(at)
        if b == 0x0D or b == 0x0A then
            local empty = at == from
            if not empty or (to_drive and b == 0x0A) then
                messages[#messages + 1] = { from = from, to = at, text = data:sub(from, at - 1), ended = b == 0x0D and "CR" or "LF" }
            elseif #messages > 0 and messages[#messages].to == at - 1 then
                messages[#messages].to = at -- CR LF is one end
            end
            from = at + 1
        elseif controls[b] then
            local name = to_drive and at - from == 1 and data:sub(from, from) or nil
            if not name and at > from then messages[#messages + 1] = { from = from, to = at - 1, text = data:sub(from, at - 1), ended = "" } end
            messages[#messages + 1] = { from = name and from or at, to = at, control = controls[b], drive = name }
            from = at + 1
        elseif not to_drive and at == from and (b == 0x3E or b == 0x3F) then
            messages[#messages + 1] = { from = at, to = at, prompt = b == 0x3F }
            from = at + 1
        end
    end
    return messages, from
end

-- Text with an end of line and nothing in it that cannot be a line.
function family.sure(data)
    return data:find("[\r\n]") ~= nil and not data:find("[%z\1\2\4\7\8\11\12\14-\20\22-\26\28-\31\127]")
end

function family.show(range, m, _, tree, to_drive)
    local branch = tree:add(mcode, range)
    local words
    if m.control then
        branch:add(p.control, range(range:len() - 1, 1), m.control)
        if m.drive then branch:add(p.drive, range(0, 1), visible(m.drive)) end
        words = m.control .. (meanings[m.control] and ": " .. meanings[m.control] or "") .. (m.drive and " for " .. visible(m.drive) or "")
    elseif m.prompt ~= nil then
        branch:add(p.prompt, range, m.prompt)
        words = m.prompt and "prompt ?" or "prompt"
    else
        local text, at, wrong = m.text, 0, false
        local last = #text > 0 and text:byte(#text) or 0
        if last >= 0x80 then
            local sum = 0
            for k = 1, #text do
                sum = sum + text:byte(k)
            end
            local good = sum % 128 == 0
            branch:add(p.check, range(#text - 1, 1))
            branch:add(p.good, range(#text - 1, 1), good):set_generated()
            if not good then branch:add_proto_expert_info(e_check) end
            wrong = not good
            text = text:sub(1, -2)
        end
        local who = ""
        if to_drive and m.ended == "LF" and #text > 0 then
            local name = text:sub(1, 1)
            who = name == "*" and "all" or name == "^" and "queue" or visible(name)
            branch:add(p.drive, range(0, 1), who)
            text, at = text:sub(2), 1
        end
        if #text > 0 then
            if text:find("[\127-\255]") then branch:add_proto_expert_info(e_strange) end
            branch:add(p.text, range(at, #text), visible(text))
            text = visible(text)
            local word = to_drive and text:match("^%s*(%a+%d?)") or nil
            if word then
                local known = ((_G.axisgate_names or {}).mcode or { words = {} }).words
                word = word:upper()
                if not known[word] then word = word:match("^%a+") end
                branch:add(p.word, word):set_generated()
                if known[word] then branch:add(p.meaning, known[word]):set_generated() end
            end
        end
        branch:add(p.ended, m.ended):set_generated()
        words = (#who > 0 and "to " .. who .. ": " or "") .. (#text > 0 and text or to_drive and "wakes the party line" or "") .. (wrong and " [checksum wrong]" or "")
    end
    branch:append_text(", " .. words)
    return words
end

function mcode.dissector(tvb, pinfo, tree) return axisgate_lines.stream("mcode", tvb, pinfo, tree) end
DissectorTable.get("tcp.port"):add(503, mcode)
DissectorTable.get("udp.port"):add(503, mcode)
