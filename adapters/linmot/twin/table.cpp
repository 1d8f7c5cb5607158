#include "adapters/linmot/twin/table.hpp"

#include <algorithm>
#include <cmath>

#include "adapters/linmot/twin/bytes.hpp"

namespace axisgate::linmot::twin {

/// By the pair of sub IDs; the waits 22xh and the branches 258h..25Fh use the same.
std::optional<double> Watched::value(std::uint8_t sub) const {
    switch (sub / 2) {
        case 0:
            return demand.position;
        case 1:
            return actual.position;
        case 2:
            return demand.position - actual.position;
        case 3:
            return std::fabs(demand.position - actual.position);
        case 4:
            return demand.velocity / 10;  // 1e-6 m/s
        case 5:
            return actual.velocity / 10;
        case 7:
            return current;
        default:
            return std::nullopt;
    }
}

/// Offsets in an entry: 0 version, 2 linked entry (FFFFh: none), 4 header, 6 parameters.
std::optional<Bytes> Table::begin(std::uint16_t id, std::uint16_t last) {
    const auto it = entries_.find(id);
    if (it == entries_.end() || id > last) {
        end();
        return std::nullopt;
    }
    entry_ = id;
    waiting_ = 0;
    branch_ = 0;
    wait_until_ = never;
    ++starts_;
    Bytes b{};
    std::copy_n(it->second.begin() + 4, b.size(), b.begin());
    return b;
}

void Table::begun(std::uint16_t id, Instant now) noexcept {
    --starts_;
    if (entry_ == id) step_at_ = now + cycle;
}

std::optional<std::uint16_t> Table::next() {
    const auto it = entries_.find(entry_);
    const std::uint16_t to = it == entries_.end() ? std::uint16_t{0} : branch_ != 0 ? branch_ : at16(it->second, 2);
    if (to == 0 || to == 0xFFFF) {
        end();
        return std::nullopt;
    }
    waiting_ = 0;
    return to;
}

bool Table::change(std::uint16_t id, std::size_t at, std::span<const std::uint8_t> bytes) {
    const auto it = entries_.find(id);
    if (it == entries_.end()) return false;
    for (std::size_t i = 0; i < bytes.size() && at + i < it->second.size(); ++i)
        it->second[at + i] = bytes[i];
    return true;
}

void Table::wait(std::uint16_t header, const Bytes& b, Instant now) {
    const int sub = header >> 4 & 0x0F;
    waiting_ = header & 0xFFF0;
    wait_bytes_ = b;
    edge_ = false;
    wait_until_ = never;
    if (header >> 8 == 0x21 && (sub == 0 || sub >= 8)) {
        const double ticks = sub == 0 ? at32(b, 2) : std::max(0.0, memory_.number(sub == 8 ? 0x1E72 : 0x1E73));
        wait_until_ = now + Duration{static_cast<std::int64_t>(ticks * 100'000)};
    }
}

bool Table::over(const Watched& seen, Instant now) const {
    switch (waiting_) {
        case 0:
            return now >= step_at_;
        case 0x2110:
            return !seen.moves;
        case 0x2120:
            return seen.in_target;
        case 0x2130:
        case 0x2140:
            return edge_;
        case 0x2100:
        case 0x2180:
        case 0x2190:
            return now >= wait_until_;
        default:
            break;
    }
    const auto sub = static_cast<std::uint8_t>(waiting_ >> 4 & 0x0F);
    const auto value = seen.value(sub);
    if (!value) return true;
    const double level = sub >= 0x0E ? signed16(wait_bytes_, 2) : signed32(wait_bytes_, 2);
    return (sub & 1) == 0 ? *value > level : *value < level;
}

Instant Table::due(Instant now, Instant motion_end) const noexcept {
    if (waiting_ == 0) return step_at_;
    if (waiting_ == 0x2110) return motion_end;
    if (wait_until_ != never) return wait_until_;
    return waiting_ >> 8 == 0x22 || waiting_ == 0x2120 ? now + watch_step : never;
}

}  // namespace axisgate::linmot::twin
