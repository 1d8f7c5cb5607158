-- SimpleCAN: the UIM342 on CAN: producer, consumer and control word in the 29-bit identifier, 0 to 8 data bytes.
-- In: CAN frames; found by the identifier's form and by node 4, the one master. Out: fields simplecan.*, and uim342.* of uimessage.lua.
-- Never takes a frame whose reserved bits are set: that is another protocol's.
_G.axisgate_lines = _G.axisgate_lines or {} -- scripts share nothing but this
local axisgate_lines = _G.axisgate_lines

local can = Proto("simplecan", "SimpleCAN")
local p = {
    producer = ProtoField.uint8("simplecan.producer", "From"),
    consumer = ProtoField.uint8("simplecan.consumer", "To"),
}
can.fields = { p.producer, p.consumer }

local id_of = Field.new("can.id")
local extended = Field.new("can.flags.xtd")
local remote = Field.new("can.flags.rtr")
local host = 4

local function parts()
    local id, x, r = id_of(), extended(), remote()
    if not id or not x or not x.value or (r and r.value) then return nil end
    local v = id.value
    if bit.band(v, 0x00043F00) ~= 0 then return nil end
    local producer = bit.bor(bit.band(bit.rshift(v, 24), 0x1F), bit.lshift(bit.band(bit.rshift(v, 16), 3), 5))
    local consumer = bit.bor(bit.band(bit.rshift(v, 19), 0x1F), bit.lshift(bit.band(bit.rshift(v, 14), 3), 5))
    return producer, consumer, bit.band(v, 0xFF)
end

local function named(id) return id == 0 and "all" or id == host and "host" or tostring(id) end

function can.dissector(tvb, pinfo, tree)
    local producer, consumer, cw = parts()
    if not producer or tvb:len() > 8 then return 0 end
    local branch = tree:add(can, tvb())
    branch:add(p.producer, producer):set_generated()
    branch:add(p.consumer, consumer):set_generated()
    local to_drive = producer == host or (consumer ~= host and bit.band(cw, 0x80) ~= 0)
    local words = axisgate_lines.uim342(nil, cw, tvb:len() > 0 and tvb() or nil, branch, to_drive)
    branch:append_text(string.format(", %s -> %s, %s", named(producer), named(consumer), words))
    pinfo.cols.protocol = "SimpleCAN"
    pinfo.cols.info = string.format("%s -> %s  %s", named(producer), named(consumer), words)
    return tvb:len()
end

can:register_heuristic("can", function(tvb, pinfo, tree)
    local producer, consumer = parts()
    if not producer or (producer ~= host and consumer ~= host) or tvb:len() > 8 then return false end
    can.dissector(tvb, pinfo, tree)
    return true
end)
DissectorTable.get("can.subdissector"):add_for_decode_as(can)
