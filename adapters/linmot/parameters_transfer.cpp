// Command table entries and curves are read and written word by word, and read back after a write. A single word is never repeated, because
// the drive counts the words: after a time-out the whole transfer begins again.
#include <fmt/core.h>

#include <algorithm>

#include "adapters/linmot/drive.hpp"
#include "adapters/linmot/parameters_tables.hpp"

namespace axisgate::linmot {
namespace {
constexpr std::uint8_t done = 0x00, unfinished = 0x04, missing = 0xD4;
std::uint32_t word_at(const std::vector<std::uint8_t>& b, std::size_t at) {
    std::uint32_t v = 0;
    for (std::size_t i = 0; i < 4 && at + i < b.size(); ++i)
        v |= std::uint32_t{b[at + i]} << 8 * i;
    return v;
}
}  // namespace

Transfer& Transfers::now() const noexcept { return drive_.jobs.job().transfer; }
bool Transfers::active() const noexcept { return now().active; }

void Transfers::begin_read(bool curve, std::uint16_t id) { now() = {.active = true, .curve = curve, .id = id}; }
void Transfers::begin_write(bool curve, std::uint16_t id, std::vector<std::uint8_t> first, std::vector<std::uint8_t> second) {
    now() = {.active = true, .curve = curve, .write = true, .id = id, .blocks = {std::move(first), std::move(second)}};
}

/// Steps: 0 clear or read the sizes; 1 allocate; 2 and 3 write the blocks; 4 and 5 read them.
std::optional<Telegram> Transfers::request() {
    const Transfer& x = now();
    const std::uint8_t id = drive_.id();
    const Main main = x.curve ? Main::curves : Main::table;
    const auto ask = [&](std::uint8_t sub) { return request16(id, main, sub, x.id); };
    switch (x.step) {
        case 0:
            if (!x.write) return ask(x.curve ? 0x08 : 0x05);
            return ask(0x02);
        case 1:
            if (!x.curve) return request48(id, main, 0x03, x.id, static_cast<std::uint32_t>(entry_size));
            return request48(id, main, 0x04, x.id, static_cast<std::uint32_t>(x.blocks[0].size() | x.blocks[1].size() << 16));
        case 2:
        case 3:
            return request48(id, main, static_cast<std::uint8_t>((x.curve ? 0x05 : 0x04) + x.step - 2), x.id,
                             word_at(x.blocks[static_cast<std::size_t>(x.step - 2)], x.at));
        default:
            return ask(static_cast<std::uint8_t>((x.curve ? 0x09 : 0x06) + x.step - 4));
    }
}

bool Transfers::answered(const Telegram& telegram, Turn& t) {
    Transfer& x = now();
    const auto a = config_of(telegram);
    const auto fail = [&](Outcome outcome, std::string why, std::int32_t code = 0) {
        const std::string what = fmt::format("{} {} of drive {}", x.curve ? "curve" : "command table entry", x.id, drive_.title());
        drive_.jobs.over({outcome, Reason::drive_refused, fmt::format("{}: {}", what, why), code}, t);
        return false;
    };
    if (!a) return fail(Outcome::failed, "the answer has another form");
    const auto refused = [&] { return fail(Outcome::refused, communication_text(a->communication), a->communication); };
    if (x.step == 0) {
        const bool absent = a->communication == missing;
        if (a->communication != done && !absent) return refused();
        if (x.write) {
            if (x.blocks[0].empty()) return true;
            x.step = 1;
            return false;
        }
        if (absent) return true;
        x.sizes = {x.curve ? a->value & 0xFFFF : static_cast<std::uint32_t>(entry_size), x.curve ? a->value >> 16 : 0};
        x.step = x.sizes[0] != 0 ? 4 : 5;
        return x.sizes[0] == 0 && x.sizes[1] == 0;
    }
    if (a->communication != done && a->communication != unfinished) return refused();
    if (x.step == 1) {
        x.sizes = {static_cast<std::uint32_t>(x.blocks[0].size()), static_cast<std::uint32_t>(x.blocks[1].size())};
        x.step = 2;
        x.at = 0;
        return false;
    }
    const std::size_t block = static_cast<std::size_t>(x.step) % 2;
    if (x.step >= 4) {
        for (int i = 0; i < 4 && x.seen[block].size() < x.sizes[block]; ++i)
            x.seen[block].push_back(static_cast<std::uint8_t>(a->value >> 8 * i));
    }
    x.at += 4;
    const bool full = x.at >= x.sizes[block];
    // The drive and the gateway must agree on the end of a block; otherwise a word was lost or was received twice.
    if (full != (a->communication == done)) return fail(Outcome::failed, "the drive ends its block at another place");
    if (!full) return false;
    x.at = 0;
    const bool more = block == 0 && x.sizes[1] != 0;
    if (x.step < 4) {
        x.step = more ? 3 : 4;
        return false;
    }
    if (more) {
        x.step = 5;
        return false;
    }
    if (x.write && x.seen != x.blocks) return fail(Outcome::failed, "it reads back other than it was written");
    return true;
}

std::string Transfers::text() const {
    const Transfer& x = now();
    const auto& b = x.write ? x.blocks : x.seen;
    return x.curve ? curve_text(x.id, b[0], b[1]) : entry_text(drive_.bus.motions, b[0]);
}

bool Transfers::again() {
    Transfer& x = now();
    if (!x.active || ++x.tries >= 3) return false;
    x.step = 0;
    x.at = 0;
    x.seen = {};
    return true;
}

}  // namespace axisgate::linmot
