// The message groups besides control words and motion commands: parameters, curves, programs, errors, command table. Answers have the form
// of the public pages; answers that no page shows are marked where they are made. The flash memory is not written while the software runs.
#include <algorithm>

#include "adapters/linmot/twin/bytes.hpp"
#include "adapters/linmot/twin/device.hpp"

namespace axisgate::linmot::twin {

void Device::parameters(std::uint8_t sub, Data data, Out& out) {
    const std::uint16_t upid = at16(data, 0);
    const auto reply = static_cast<std::uint8_t>(0x50 + sub);
    if (sub == 0x0A) {
        list_open_ = true;
        list_next_ = upid;
        return config(reply, ok, upid, 0, out);
    }
    if (sub == 0x0B) {
        if (!list_open_) return config(reply, not_started, 0, 0, out);
        // A list ends with its software layer: the upper four bits of the number.
        const auto* f = drive_.memory.from(list_next_);
        if (!f || f->upid >> 12 != list_next_ >> 12) {
            list_open_ = false;
            return config(reply, list_end, 0, 0, out);
        }
        list_next_ = static_cast<std::uint16_t>(f->upid + 1);
        return config(reply, ok, f->upid, std::uint32_t{f->usage} | std::uint32_t{f->type} << 16, out);
    }
    const auto* f = drive_.memory.facts(upid);
    if (sub > 7 || sub == 2) return;
    if (sub >= 3 && !manners().parameter_info) return;
    if (data.size() < 2) return;
    if (!f) return config(reply, no_upid, upid, 0, out);
    switch (sub) {
        case 0:
            return config(reply, f->in_rom() ? ok : usage, upid, drive_.memory.rom(upid), out);
        case 1:
            if (data.size() < 6) return config(reply, wrong_size, upid, 0, out);
            if (!f->writable_rom()) return config(reply, usage, upid, 0, out);
            drive_.memory.set_rom(upid, at32(data, 2));
            return config(reply, ok, upid, drive_.memory.rom(upid), out);
        case 3:
            return config(reply, ok, upid, f->usage, out);
        case 4:
            return config(reply, ok, upid, f->type, out);
        case 5:
            return config(reply, ok, upid, Memory::lowest(f->type), out);
        case 6:
            return config(reply, ok, upid, Memory::highest(f->type), out);
        default:
            return config(reply, ok, upid, Memory::fit(f->type, static_cast<std::uint32_t>(f->factory)), out);
    }
}

/// The layouts of all except 0Ah are inferred from the other buses of this family.
void Device::curves(std::uint8_t sub, Data data, Out& out) {
    if (setup_.drive.series == Series::b1100) return;
    const std::uint16_t id = at16(data, 0);
    const Duration time = sub == 0 ? manners().save : sub <= 6 ? manners().table_write : Duration{};
    const auto reply = [&](std::uint8_t state, std::uint32_t value = 0) {
        Out own;
        config(0x40, state, id, value, time == Duration::zero() ? out : own);
        answer_later(time, own);
    };
    auto& all = drive_.curves;
    if (sub != block_sub_ || id != block_id_) block_at_ = 0;
    block_sub_ = sub;
    block_id_ = id;
    const auto found = all.find(id);
    switch (sub) {
        case 0x00:
            if (drive_.software_runs()) return reply(not_stopped);
            curves_flash_ = all;
            ++revision_;
            return reply(ok);
        case 0x01:
            return all.clear(), reply(ok);
        case 0x02:
            return reply(all.erase(id) != 0 ? ok : missing);
        case 0x04:
            if (found != all.end() || id < 1 || id > 100) return reply(missing);
            if (at16(data, 2) % 2 != 0 || at16(data, 4) % 4 != 0) return reply(wrong_size);
            all[id] = {};
            block_sizes_[id] = {at16(data, 2), at16(data, 4)};
            return reply(ok);
        case 0x05:
        case 0x06: {
            if (found == all.end() || !block_sizes_.contains(id)) return reply(missing);
            auto& block = sub == 5 ? found->second.info : found->second.data;
            const std::size_t size = sub == 5 ? block_sizes_[id].first : block_sizes_[id].second;
            for (std::size_t i = 0; i < 4 && block.size() < size; ++i)
                block.push_back(data.size() > 2 + i ? data[2 + i] : std::uint8_t{0});
            return reply(block.size() < size ? unfinished : ok);
        }
        case 0x08:
            if (found == all.end()) return reply(missing);
            return reply(ok, static_cast<std::uint32_t>(found->second.info.size() | found->second.data.size() << 16));
        case 0x09:
        case 0x0A: {
            if (found == all.end()) return reply(missing);
            const auto& block = sub == 9 ? found->second.info : found->second.data;
            const std::uint32_t value = at32(block, block_at_);
            block_at_ += 4;
            const bool more = block_at_ < block.size();
            if (!more) block_at_ = 0;
            return reply(more ? unfinished : ok, value);
        }
        default:
            return;
    }
}

void Device::program(std::uint8_t sub, Instant now, Out& out) {
    const auto later = [&] {
        Out one;
        answer(0x60, {ok}, one);
        reply_.clear();
        if (!one.frames.empty()) reply_.assign(one.frames[0].frame.data().begin(), one.frames[0].frame.data().end());
        reply_at_ = now + manners().restart;
    };
    switch (sub) {
        case 1:
        case 2:
            start(now);
            if (sub == 2)
                default_response(out);
            else
                later();
            deaf_until_ = now + manners().restart;
            return;
        case 3:
            drive_.stop_software(now);
            return default_response(out);
        case 4:
            if (!drive_.software_runs()) drive_.start_software(now);
            return later();
        default:
            return;
    }
}

void Device::errors(std::uint8_t sub, Data data, Out& out) const {
    std::vector<std::uint8_t> d{ok};
    if (sub == 2) {
        put(d, 21, 2);
        put(d, errors_seen_, 2);
        return answer(0x72, std::move(d), out);
    }
    if (sub > 1 || (sub == 1 && setup_.drive.series == Series::b1100)) return;
    const std::uint16_t code = sub == 1 ? at16(data, 0) : drive_.error_code();
    if (sub == 1) put(d, code, 2);
    const auto it = setup_.error_texts.find(code);
    std::string text = it == setup_.error_texts.end() ? "No Err" : it->second;
    text.resize(32, '\0');
    d.insert(d.end(), text.begin(), text.end());
    answer(static_cast<std::uint8_t>(0x70 + sub), std::move(d), out);
}

/// 03h to 06h are inferred from the other buses of this family.
void Device::command_table(std::uint8_t sub, Data data, Out& out) {
    if (setup_.drive.series == Series::b1100) return;
    const std::uint16_t id = at16(data, 0);
    const Duration time = sub == 0 ? manners().save : sub <= 4 ? manners().table_write : Duration{};
    const auto reply = [&](std::uint8_t state, std::uint32_t value = 0) {
        Out own;
        config(static_cast<std::uint8_t>(0x80 + sub), state, id, value, time == Duration::zero() ? out : own);
        answer_later(time, own);
    };
    auto& table = drive_.table;
    if (sub != block_sub_ || id != block_id_) block_at_ = 0;
    block_sub_ = sub;
    block_id_ = id;
    const auto found = table.find(id);
    switch (sub) {
        case 0:
            if (drive_.software_runs()) return reply(not_stopped);
            table_flash_ = table;
            ++revision_;
            return reply(ok);
        case 1:
            return table.clear(), reply(ok);
        case 2:
            table.erase(id);
            return reply(ok);
        case 3:
            if (id < 1 || id > 255) return reply(missing);
            table[id] = {};
            return reply(ok);
        case 4:
            if (found == table.end()) return reply(missing);
            for (std::size_t i = 0; i < 4 && block_at_ + i < 64; ++i)
                found->second[block_at_ + i] = data.size() > 2 + i ? data[2 + i] : std::uint8_t{0};
            block_at_ += 4;
            if (block_at_ >= 64) return block_at_ = 0, reply(ok);
            return reply(unfinished);
        case 5:
            return reply(found == table.end() ? missing : ok, found == table.end() ? 0 : 64);
        case 6: {
            if (found == table.end()) return reply(missing);
            const std::uint32_t value = at32(found->second, block_at_);
            block_at_ += 4;
            if (block_at_ >= 64) return block_at_ = 0, reply(ok, value);
            return reply(unfinished, value);
        }
        case 7: {
            std::uint32_t bits = 0xFFFF'FFFFu;  // a bit of 0: the entry exists
            for (const auto& [k, entry] : table) {
                if (k / 32 == id) bits &= ~(1u << k % 32);
            }
            return reply(ok, id <= 7 ? bits : 0xFFFF'FFFFu);
        }
        default:
            return;
    }
}

}  // namespace axisgate::linmot::twin
