// A digit that the manual does not name is not accepted.
#include "adapters/aposs/twin/coded.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>

namespace axisgate::aposs {

std::optional<EncoderCode> encoder_of(std::int64_t v, bool of_master) {
    const std::int64_t size = std::abs(v);
    EncoderCode e;
    if (v < 0 && size <= 1000) {  // command value of another axis, only possible for a master (E-37)
        if (!of_master || size > 9) return std::nullopt;
        e.source = Encoder::axis_command;
        e.number = static_cast<int>(size);
        return e;
    }
    switch (v) {
        case 0:
            return e;
        case 1:
        case 2:
            e.source = Encoder::absolute;
            return e;
        case 3:
        case 4:
            e.source = Encoder::linear_absolute;
            return of_master ? std::nullopt : std::optional(e);
        case 5:
            e.source = Encoder::sine_cosine;
            return e;
        case 6:
        case 9:  // 6: simulation of a master, 9: of a slave
            e.source = Encoder::simulation;
            return of_master == (v == 6) ? std::optional(e) : std::nullopt;
        case 10:
        case 20:
        case 30:
            e.number = static_cast<int>(v / 10);
            return e;
        default:
            break;
    }
    if (v >= 251'000 && v < 252'000) {
        e.source = Encoder::ethercat;
        e.pdo = static_cast<int>((v - 251'000) / 100);
        e.first_long = static_cast<int>(v % 100);
        return e;
    }
    if (size < 1000 || size >= 200'000) return std::nullopt;
    e.source = Encoder::can;
    e.guarded = v > 0;
    e.slave_bus = size >= 100'000;
    e.device = static_cast<int>(size % 100'000 / 1000);
    const auto id = static_cast<int>(size % 1000);
    const bool known = e.device <= 50 || (!of_master && e.device >= 91 && e.device <= 94);
    if (!known || (e.device == 0 && !e.slave_bus)) return std::nullopt;  // E-38
    if (id >= 1 && id <= 127) {
        e.number = id;
        e.pdo = 2;
        return e;
    }
    if (id < 257 || id > 383 || e.device != 1) return std::nullopt;  // E-15
    e.number = id - 256;
    e.pdo = 3;
    return e;
}

std::optional<ReversCode> revers_of(std::int64_t v) {
    ReversCode r;
    if (v < 0) {
        if (v < -90 || v % 10 != 0) return std::nullopt;
        r.direction_output = static_cast<int>(-v / 10);
        r.two_outputs = true;
        return r;
    }
    r.mode = static_cast<int>(v % 10);
    r.direction_output = static_cast<int>(v / 10 % 10);
    r.node = static_cast<int>(v / 100);
    return v <= 12'782 && r.mode <= 2 && r.direction_output <= 8 && r.node <= 127 ? std::optional(r) : std::nullopt;
}

std::optional<DirectionCode> direction_of(std::int64_t v) {
    const std::int64_t size = std::abs(v), both = size < 10 ? size * 11 : size;
    const auto velocity = both / 10, position = both % 10;
    if (velocity < 1 || velocity > 2 || position < 1 || position > 2 || size == 11) return std::nullopt;  // E-09
    return DirectionCode{velocity == 2, position == 2, v < 0};
}

std::optional<MarkerCode> marker_of(std::int64_t v, bool with_gate) {
    const std::int64_t size = std::abs(v), kind = size % 10;
    if (kind > 3 || size > 993 || (v < 0 && size < 100) || (size >= 100 && !with_gate)) return std::nullopt;
    return MarkerCode{kind >= 2, kind % 2 == 1, static_cast<int>(size / 10 % 10), static_cast<int>(v / 100)};
}

std::optional<DriveCode> drive_of(std::int64_t v) {
    constexpr std::array types{1, 2, 3, 4, 5, 10, 11, 12, 13, 91, 92, 93, 94};
    if (v == 0) return DriveCode{};
    const std::int64_t size = std::abs(v);
    const bool own = size > 100;
    const auto type = static_cast<int>(own ? size - 100 : size);
    if (std::ranges::find(types, type) == types.end()) return std::nullopt;
    return DriveCode{type, v > 0, own};
}

std::optional<ProgramCode> program_of(std::int64_t v) {
    const bool off = v >= 999;
    const std::int64_t program = off ? v - 1000 : v;
    if (program < -1 || program > 127) return std::nullopt;
    return ProgramCode{static_cast<int>(program), off};
}

std::optional<int> chosen_program(std::uint32_t inputs, std::int64_t choice, std::int64_t start) {
    if (choice < 1 || start <= choice || start > 32) return std::nullopt;
    const auto number = inputs >> (choice - 1) & ((1u << (start - choice)) - 1);
    return number <= 89 ? std::optional(static_cast<int>(number)) : std::nullopt;
}

std::optional<VirtualMasterCode> virtual_master_of(std::int64_t v) {
    if (v < 0 || v >= 200'000) return std::nullopt;
    VirtualMasterCode c{static_cast<int>(v % 100'000 / 100), static_cast<int>(v % 100), v >= 100'000};
    return c.axis <= 9 ? std::optional(c) : std::nullopt;
}

std::optional<std::pair<int, int>> baud_of(std::int64_t v) {
    constexpr std::array rates{5, 10, 20, 50, 100, 125, 250, 500, 1000};
    const std::int64_t master = v < 10 ? v : v / 10, slave = v % 10;
    if (v < 0 || master > 8 || slave > 8) return std::nullopt;
    return std::pair{rates.at(static_cast<std::size_t>(master)), rates.at(static_cast<std::size_t>(slave))};
}

bool means_something(std::string_view id, std::int64_t v) {
    if (id == "ENCODERTYPE") return encoder_of(v, false).has_value();
    if (id == "MENCODERTYPE") return encoder_of(v, true).has_value();
    if (id == "REVERS") return revers_of(v).has_value();
    if (id == "POSDRCT") return direction_of(v).has_value();
    if (id == "SYNCMTYPM") return marker_of(v, true).has_value();
    if (id == "SYNCMTYPS") return marker_of(v, false).has_value();
    if (id == "VMENCMTYP") {
        const auto m = marker_of(v, false);
        return m && (m->external || !m->falling);  // E-16: 1 does not exist
    }
    if (id == "DRIVETYPE") return drive_of(v).has_value();
    if (id == "PRGPAR") return program_of(v).has_value();
    if (id == "VMENCTYP") return virtual_master_of(v).has_value();
    if (id == "CANBAUD") return baud_of(v).has_value();
    if (id == "SYNCTYPE") return v >= 0 && (v & ~std::int64_t{7}) == 0;
    if (id == "SYNCMFPAR") return v >= 0 && (v & ~std::int64_t{87}) == 0;
    if (id == "SYNCMSTART") return (v >= 0 && v <= 7) || (v >= 1000 && v <= 1007) || v == 2000;
    if (id == "SYNCFACTM") return v != 0;  // a divisor (E-48)
    if (id == "CANNR") return v <= 2048 || v == 9999;
    return true;
}

}  // namespace axisgate::aposs
