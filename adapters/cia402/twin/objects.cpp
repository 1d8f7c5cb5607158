#include "adapters/cia402/twin/objects.hpp"

#include <algorithm>
#include <array>

#include "adapters/cia402/twin/homing.hpp"

namespace axisgate::cia402_drive::twin {
namespace {
using canopen::DataType;
using canopen::EntryAccess;
using canopen::Mappable;
constexpr auto u8 = DataType::unsigned8, u16 = DataType::unsigned16, u32 = DataType::unsigned32, i8 = DataType::integer8,
               i16 = DataType::integer16, i32 = DataType::integer32, str = DataType::visible_string;
constexpr auto ro = EntryAccess::read_only, rw = EntryAccess::read_write, con = EntryAccess::constant;
constexpr auto no = Mappable::no, tx = Mappable::transmit, both = Mappable::both;
constexpr std::int64_t any = INT64_MIN;

struct Row {
    std::uint16_t index;
    std::uint8_t sub;
    DataType type;
    EntryAccess access;
    Mappable mappable;
    std::int64_t value;
    const char* name;
    std::int64_t low = any, high = any;
};
constexpr Row rows[] = {
    {0x1000, 0, u32, ro, no, 0x00020192, "Device type"},
    {0x1001, 0, u8, ro, tx, 0, "Error register"},
    {0x1003, 0, u8, rw, no, 0, "Number of errors", 0, 0},
    {0x1003, 1, u32, ro, no, 0, "Newest error"},
    {0x1003, 2, u32, ro, no, 0, "Error before"},
    {0x1003, 3, u32, ro, no, 0, "Error before"},
    {0x1003, 4, u32, ro, no, 0, "Error before"},
    {0x1005, 0, u32, rw, no, 0x80, "COB-ID SYNC"},
    {0x1006, 0, u32, rw, no, 0, "Communication cycle period"},
    {0x100C, 0, u16, rw, no, 0, "Guard time"},
    {0x100D, 0, u8, rw, no, 0, "Life time factor"},
    {0x1010, 0, u8, con, no, 1, "Store parameters"},
    {0x1010, 1, u32, rw, no, 1, "Save all parameters"},
    {0x1011, 0, u8, con, no, 1, "Restore default parameters"},
    {0x1011, 1, u32, rw, no, 1, "Restore all default parameters"},
    {0x1015, 0, u16, rw, no, 0, "Inhibit time EMCY"},
    {0x1016, 0, u8, con, no, 1, "Consumer heartbeat time"},
    {0x1016, 1, u32, rw, no, 0, "Consumer heartbeat time 1"},
    {0x1017, 0, u16, rw, no, 0, "Producer heartbeat time"},
    {0x1018, 0, u8, con, no, 4, "Identity object"},
    {0x1018, 1, u32, ro, no, 0x7FFF, "Vendor ID"},
    {0x1018, 2, u32, ro, no, 0x402, "Product code"},
    {0x1018, 3, u32, ro, no, 0x10001, "Revision number"},
    {0x1018, 4, u32, ro, no, 4711, "Serial number"},
    {0x1019, 0, u8, rw, no, 0, "Synchronous counter overflow value", 0, 240},
    {0x1029, 0, u8, con, no, 1, "Error behaviour"},
    {0x1029, 1, u8, rw, no, 0, "Communication error", 0, 1},
    {0x6007, 0, i16, rw, no, 1, "Abort connection option code", 0, 3},
    {0x603F, 0, u16, ro, tx, 0, "Error code"},
    {0x6040, 0, u16, rw, both, 0, "Controlword"},
    {0x6041, 0, u16, ro, tx, 0, "Statusword"},
    {0x605A, 0, i16, rw, no, 2, "Quick stop option code", 0, 7},
    {0x605B, 0, i16, rw, no, 0, "Shutdown option code", 0, 1},
    {0x605C, 0, i16, rw, no, 1, "Disable operation option code", 0, 1},
    {0x605D, 0, i16, rw, no, 1, "Halt option code", 1, 4},
    {0x605E, 0, i16, rw, no, 2, "Fault reaction option code", 0, 4},
    {0x6060, 0, i8, rw, both, 1, "Modes of operation"},
    {0x6061, 0, i8, ro, tx, 1, "Modes of operation display"},
    {0x6062, 0, i32, ro, tx, 0, "Position demand value"},
    {0x6063, 0, i32, ro, tx, 0, "Position actual internal value"},
    {0x6064, 0, i32, ro, tx, 0, "Position actual value"},
    {0x6065, 0, u32, rw, no, 2000, "Following error window"},
    {0x6066, 0, u16, rw, no, 50, "Following error time out"},
    {0x6067, 0, u32, rw, no, 5, "Position window"},
    {0x6068, 0, u16, rw, no, 0, "Position window time"},
    {0x606B, 0, i32, ro, tx, 0, "Velocity demand value"},
    {0x606C, 0, i32, ro, tx, 0, "Velocity actual value"},
    {0x606D, 0, u16, rw, no, 10, "Velocity window"},
    {0x606E, 0, u16, rw, no, 0, "Velocity window time"},
    {0x606F, 0, u16, rw, no, 1, "Velocity threshold"},
    {0x6071, 0, i16, rw, both, 0, "Target torque"},
    {0x6072, 0, u16, rw, both, 1000, "Max torque"},
    {0x6073, 0, u16, rw, no, 1000, "Max current"},
    {0x6074, 0, i16, ro, tx, 0, "Torque demand"},
    {0x6075, 0, u32, rw, no, 2000, "Motor rated current"},
    {0x6076, 0, u32, rw, no, 500, "Motor rated torque"},
    {0x6077, 0, i16, ro, tx, 0, "Torque actual value"},
    {0x6078, 0, i16, ro, tx, 0, "Current actual value"},
    {0x6079, 0, u32, ro, tx, 48000, "DC link circuit voltage"},
    {0x607A, 0, i32, rw, both, 0, "Target position"},
    {0x607C, 0, i32, rw, no, 0, "Home offset"},
    {0x607D, 0, u8, con, no, 2, "Software position limit"},
    {0x607D, 1, i32, rw, no, 0, "Min position limit"},
    {0x607D, 2, i32, rw, no, 0, "Max position limit"},
    {0x607E, 0, u8, rw, no, 0, "Polarity", 0, 0xC0},
    {0x607F, 0, u32, rw, no, 1'000'000, "Max profile velocity", 1},
    {0x6080, 0, u32, rw, no, 1'000'000, "Max motor speed", 1},
    {0x6081, 0, u32, rw, both, 10'000, "Profile velocity"},
    {0x6083, 0, u32, rw, both, 50'000, "Profile acceleration", 1},
    {0x6084, 0, u32, rw, both, 50'000, "Profile deceleration", 1},
    {0x6085, 0, u32, rw, both, 200'000, "Quick stop deceleration", 1},
    {0x6086, 0, i16, rw, no, 0, "Motion profile type", 0, 3},
    {0x6087, 0, u32, rw, no, 1'000'000, "Torque slope", 1},
    {0x608F, 0, u8, con, no, 2, "Position encoder resolution"},
    {0x608F, 1, u32, rw, no, 1, "Encoder increments", 1},
    {0x608F, 2, u32, rw, no, 1, "Motor revolutions", 1},
    {0x6091, 0, u8, con, no, 2, "Gear ratio"},
    {0x6091, 1, u32, rw, no, 1, "Motor shaft revolutions", 1},
    {0x6091, 2, u32, rw, no, 1, "Driving shaft revolutions", 1},
    {0x6092, 0, u8, con, no, 2, "Feed constant"},
    {0x6092, 1, u32, rw, no, 1, "Feed", 1},
    {0x6092, 2, u32, rw, no, 1, "Shaft revolutions", 1},
    {0x6096, 0, u8, con, no, 2, "Velocity factor"},
    {0x6096, 1, u32, rw, no, 1, "Numerator", 1},
    {0x6096, 2, u32, rw, no, 1, "Divisor", 1},
    {0x6098, 0, i8, rw, no, 37, "Homing method"},
    {0x6099, 0, u8, con, no, 2, "Homing speeds"},
    {0x6099, 1, u32, rw, no, 20'000, "Speed during search for switch", 1},
    {0x6099, 2, u32, rw, no, 1'000, "Speed during search for zero", 1},
    {0x609A, 0, u32, rw, no, 50'000, "Homing acceleration", 1},
    {0x60A3, 0, u8, rw, no, 1, "Profile jerk use", 1, 4},
    {0x60A4, 0, u8, con, no, 4, "Profile jerk"},
    {0x60A4, 1, u32, rw, no, 0, "Profile jerk 1"},
    {0x60A4, 2, u32, rw, no, 0, "Profile jerk 2"},
    {0x60A4, 3, u32, rw, no, 0, "Profile jerk 3"},
    {0x60A4, 4, u32, rw, no, 0, "Profile jerk 4"},
    {0x60B8, 0, u16, rw, both, 0, "Touch probe function"},
    {0x60B9, 0, u16, ro, tx, 0, "Touch probe status"},
    {0x60BA, 0, i32, ro, tx, 0, "Touch probe 1 positive edge"},
    {0x60BB, 0, i32, ro, tx, 0, "Touch probe 1 negative edge"},
    {0x60BC, 0, i32, ro, tx, 0, "Touch probe 2 positive edge"},
    {0x60BD, 0, i32, ro, tx, 0, "Touch probe 2 negative edge"},
    {0x60C1, 0, u8, con, no, 1, "Interpolation data record"},
    {0x60C1, 1, i32, rw, both, 0, "Interpolation set-point"},
    {0x60C2, 0, u8, con, no, 2, "Interpolation time period"},
    {0x60C2, 1, u8, rw, no, 20, "Interpolation time period value", 1},
    {0x60C2, 2, i8, rw, no, -3, "Interpolation time index", -6, 0},
    {0x60C5, 0, u32, rw, no, 1'000'000, "Max acceleration", 1},
    {0x60C6, 0, u32, rw, no, 1'000'000, "Max deceleration", 1},
    {0x60F4, 0, i32, ro, tx, 0, "Following error actual value"},
    {0x60FD, 0, u32, ro, tx, 0, "Digital inputs"},
    {0x60FE, 0, u8, con, no, 2, "Digital outputs"},
    {0x60FE, 1, u32, rw, both, 0, "Physical outputs"},
    {0x60FE, 2, u32, rw, no, 0, "Output mask"},
    {0x60FF, 0, i32, rw, both, 0, "Target velocity"},
    {0x6502, 0, u32, ro, no, 0x3ED, "Supported drive modes"},
    {0x6402, 0, u16, rw, no, 10, "Motor type"},
};
}  // namespace

canopen::Dictionary factory_dictionary(std::uint8_t node) {
    canopen::Dictionary d;
    const auto add = [&](std::uint16_t index, std::uint8_t sub, DataType type, EntryAccess access, std::int64_t value,
                         const std::string& name, Mappable mappable = no) {
        d.add({index, sub}, {type, access, mappable, name, {}, {}, {}});
        (void)d.set({index, sub}, Value{value});
    };
    for (const Row& r : rows) {
        canopen::Entry e{r.type, r.access, r.mappable, r.name, {}, {}, {}};
        d.add({r.index, r.sub}, e);
        (void)d.set({r.index, r.sub}, Value{r.value});
        if (r.low != any) e.low = r.low;
        if (r.high != any) e.high = r.high;
        if (e.low || e.high) {
            e.bytes = d.find({r.index, r.sub})->bytes;
            d.add({r.index, r.sub}, e);
        }
    }
    add(0x1008, 0, str, con, 0, "Manufacturer device name");
    d.add({0x1008, 0},
          {str, con, no, "Manufacturer device name", {'g', 'e', 'n', 'e', 'r', 'i', 'c', ' ', 's', 'e', 'r', 'v', 'o'}, {}, {}});
    const auto methods = homing_methods();
    add(0x60E3, 0, u8, con, static_cast<std::int64_t>(methods.size()), "Supported homing methods");
    for (std::uint8_t i = 0; i < methods.size(); ++i)
        add(0x60E3, static_cast<std::uint8_t>(i + 1), i8, ro, methods[i], "Homing method");
    add(0x1014, 0, u32, rw, 0x80 + node, "COB-ID EMCY");
    add(0x1200, 0, u8, con, 2, "SDO server parameter");
    add(0x1200, 1, u32, ro, 0x600 + node, "COB-ID client to server");
    add(0x1200, 2, u32, ro, 0x580 + node, "COB-ID server to client");
    constexpr std::uint32_t receive_maps[] = {0x60400010, 0x607A0020, 0x60FF0020, 0x60710010};
    constexpr std::uint32_t transmit_maps[] = {0x60410010, 0x60640020, 0x606C0020, 0x60770010};
    for (std::uint16_t n = 0; n < 4; ++n) {
        const std::uint16_t r = static_cast<std::uint16_t>(0x1400 + n), t = static_cast<std::uint16_t>(0x1800 + n);
        const std::uint32_t off = n == 0 ? 0 : 0x80000000u;  // all PDOs but the first are disabled by default
        add(r, 0, u8, con, 2, "RPDO communication");
        add(r, 1, u32, rw, off | (0x200u + n * 0x100u + node), "COB-ID of RPDO");
        add(r, 2, u8, rw, 255, "RPDO transmission type");
        add(t, 0, u8, con, 6, "TPDO communication");
        add(t, 1, u32, rw, off | (0x180u + n * 0x100u + node), "COB-ID of TPDO");
        add(t, 2, u8, rw, 255, "TPDO transmission type");
        add(t, 3, u16, rw, 0, "TPDO inhibit time");
        add(t, 5, u16, rw, 0, "TPDO event timer");
        add(t, 6, u8, rw, 0, "TPDO SYNC start value");
        for (const std::uint16_t m : {static_cast<std::uint16_t>(r + 0x200), static_cast<std::uint16_t>(t + 0x200)}) {
            add(m, 0, u8, rw, 1, "PDO mapping");
            for (std::uint8_t i = 1; i <= 8; ++i)
                add(m, i, u32, rw, i > 1 ? 0 : m >= 0x1A00 ? transmit_maps[n] : receive_maps[n], "Mapped object");
        }
    }
    return d;
}

bool is_stored(canopen::Address a, const canopen::Entry& e) {
    constexpr std::array<std::uint16_t, 12> live{0x1003, 0x1010, 0x1011, 0x6040, 0x6060, 0x6071,
                                                 0x607A, 0x60B8, 0x60C1, 0x60FE, 0x60FF, 0x6062};
    return e.access == EntryAccess::read_write && std::ranges::find(live, a.index) == live.end();
}

}  // namespace axisgate::cia402_drive::twin
