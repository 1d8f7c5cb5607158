-- Lines of bytes in captures of the gateway (link type USER0): runs as they were read, cut anywhere, put together again for each direction.
-- In: packets; what uimessage.lua, mcode.lua, pacontrol.lua and linrs.lua have entered in axisgate_lines. Out: their messages in the tree.
-- Keeps what a message still lacks, at most 256 bytes per direction; a line has one family, told by the form of its bytes or by the preference.
_G.axisgate_lines = _G.axisgate_lines or {} -- scripts share nothing but this
local axisgate_lines = _G.axisgate_lines

local line = Proto("axisgate_line", "axisgate line")
local f_family = ProtoField.string("axisgate_line.family", "Family")
local f_direction = ProtoField.string("axisgate_line.direction", "Direction")
local f_rest = ProtoField.uint32("axisgate_line.continued", "Bytes that a later packet goes on with")
local f_junk = ProtoField.bytes("axisgate_line.strange", "Bytes that belong to no message")
line.fields = { f_family, f_direction, f_rest, f_junk }
local e_junk = ProtoExpert.new("axisgate_line.strange.expert", "Bytes that belong to no message", expert.group.PROTOCOL, expert.severity.WARN)
line.experts = { e_junk }

local names = { "automatic", "uimessage", "mcode", "pacontrol", "linrs" }
local choices = {}
for i, n in ipairs(names) do
    choices[i] = { i, n, i }
end
line.prefs.family = Pref.enum("Family", 1, "Which family speaks on lines of bytes; automatic: told by the form of the bytes", choices, false)

local interface_of = Field.new("frame.interface_id")
local most_held = 256
-- By interface: the family, once it is known, and what is held, by direction. By packet: what was made of it when it was seen first.
local lines, seen = {}, {}
function line.init()
    lines, seen = {}, {}
end

-- The family whose messages a run shows; nil: not known yet. mcode is text and is asked last.
local function told_by(data)
    for _, n in ipairs({ "uimessage", "linrs", "pacontrol", "mcode" }) do
        local family = axisgate_lines[n]
        if family and family.sure(data) then return n end
    end
    return nil
end

-- One message after the other into the tree; returns the words for the list of packets.
function axisgate_lines.show(family, tvb, pinfo, tree, messages, to_drive, branch)
    local said = {}
    for _, m in ipairs(messages) do
        local range = tvb(m.from - 1, m.to - m.from + 1)
        if m.junk then
            (branch or tree):add(f_junk, range):add_proto_expert_info(e_junk, m.junk)
            said[#said + 1] = "strange bytes"
        else
            said[#said + 1] = family.show(range, m, pinfo, tree, to_drive)
        end
    end
    return table.concat(said, " | ")
end

-- A stream over TCP: what is unfinished waits for the next segment. `port`: the drive's.
function axisgate_lines.stream(name, tvb, pinfo, tree)
    local family = axisgate_lines[name]
    local to_drive = nil
    if pinfo.match_uint == pinfo.dst_port then
        to_drive = true
    elseif pinfo.match_uint == pinfo.src_port then
        to_drive = false
    end
    local messages, rest = family.split(tvb:raw(), to_drive)
    if rest <= tvb:len() then
        pinfo.desegment_offset = rest - 1
        pinfo.desegment_len = DESEGMENT_ONE_MORE_SEGMENT
    end
    pinfo.cols.protocol = family.title
    pinfo.cols.info = axisgate_lines.show(family, tvb, pinfo, tree, messages, to_drive)
    return tvb:len()
end

local function first_look(tvb, pinfo, interface, to_drive)
    local state = lines[interface]
    if not state then
        state = { held = {} }
        lines[interface] = state
    end
    local side = to_drive == nil and "either" or to_drive and "to" or "from"
    local held = state.held[side] or ""
    local data = held .. tvb:raw()
    local wanted = names[line.prefs.family]
    if wanted ~= "automatic" then
        state.family = wanted
    else
        state.family = state.family or told_by(data)
    end
    local made = { family = state.family, data = data, own = #held == 0, messages = {}, rest = 1 }
    if state.family and axisgate_lines[state.family] then
        made.messages, made.rest = axisgate_lines[state.family].split(data, to_drive)
    end
    local left = data:sub(made.rest)
    if #left > most_held then
        made.messages[#made.messages + 1] = { from = made.rest, to = #data, junk = "no message is that long" }
        made.rest = #data + 1
        left = ""
    end
    state.held[side] = left
    return made
end

function line.dissector(tvb, pinfo, tree)
    local interface = interface_of()
    interface = interface and interface.value or 0
    local to_drive = nil
    if pinfo.p2p_dir == 0 then
        to_drive = true
    elseif pinfo.p2p_dir == 1 then
        to_drive = false
    end
    local made = seen[pinfo.number]
    if not made then
        made = first_look(tvb, pinfo, interface, to_drive)
        seen[pinfo.number] = made
    end
    local whole = tvb
    if not made.own then whole = ByteArray.new(made.data, true):tvb("Put together") end
    local branch = tree:add(line, tvb())
    if made.family then branch:add(f_family, made.family):set_generated() end
    local where = to_drive == nil and "not known" or to_drive and "to the drive" or "from the drive"
    branch:add(f_direction, where):set_generated()
    if made.rest <= #made.data then branch:add(f_rest, #made.data - made.rest + 1):set_generated() end
    pinfo.cols.src = to_drive == nil and "" or to_drive and "gateway" or "drive"
    pinfo.cols.dst = to_drive == nil and "" or to_drive and "drive" or "gateway"
    local family = made.family and axisgate_lines[made.family]
    if not family then
        pinfo.cols.protocol = "line"
        return tvb:len()
    end
    pinfo.cols.protocol = family.title
    pinfo.cols.info = axisgate_lines.show(family, whole, pinfo, tree, made.messages, to_drive, branch)
    if #made.messages == 0 and made.rest > #made.data then branch:append_text(", ends of lines alone") end
    return tvb:len()
end

DissectorTable.get("wtap_encap"):add(wtap.USER0, line)
