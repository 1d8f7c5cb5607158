// Telegrams, control words, motion commands, RAM reads, power and the simulated hand. Answers have the form of the public pages; answers
// that no page shows are marked where they are made.
#include "adapters/linmot/twin/device.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "adapters/linmot/twin/bytes.hpp"

namespace axisgate::linmot::twin {

std::uint16_t Device::sum(std::span<const std::uint8_t> bytes) const {
    const auto part = bytes.subspan(std::min(setup_.checksum_from, bytes.size()));
    if (setup_.checksum == "sum") {
        unsigned s = 0;
        for (const auto b : part)
            s += b;
        return static_cast<std::uint16_t>(s);
    }
    // Bit by bit, in the reflected form lowest bit first.
    const bool low_first = setup_.checksum == "crc_reflected";
    unsigned crc = setup_.checksum_start;
    for (const auto b : part) {
        for (int i = 0; i < 8; ++i) {
            const unsigned in = (low_first ? b >> i : b >> (7 - i)) & 1u;
            if (low_first)
                crc = ((crc ^ in) & 1u) != 0 ? crc >> 1 ^ 0x8408u : crc >> 1;
            else
                crc = ((crc >> 15 ^ in) & 1u) != 0 ? (crc << 1 ^ 0x1021u) & 0xFFFFu : crc << 1 & 0xFFFFu;
        }
    }
    return static_cast<std::uint16_t>(crc);
}

// --- power ------------------------------------------------------------------------------------------------------------------
void Device::start(Instant now) {
    drive_.table = table_flash_;
    drive_.curves = curves_flash_;
    drive_.power_on(now);
    held_.clear();
    reply_at_ = never;
    list_open_ = false;
    block_sizes_.clear();
    slow_.clear();
    shown_.forget();
    const auto first = [&](Duration period) { return period == Duration::zero() ? never : now + period; };
    foreign_at_ = first(manners().foreign);
    unsolicited_at_ = first(manners().unsolicited);
}

void Device::power_on(const NonVolatile& memory, Instant now, Out&) {
    powered_ = true;
    drive_.memory.load(memory);
    table_flash_.clear();
    curves_flash_.clear();
    const auto bytes_of = [](const Value& v) {
        std::vector<std::uint8_t> bytes;
        const auto* s = std::get_if<std::string>(&v);
        const auto digit = [](char c) { return c <= '9' ? c - '0' : (c | 0x20) - 'a' + 10; };
        for (std::size_t i = 0; s && i + 1 < s->size(); i += 2)
            bytes.push_back(static_cast<std::uint8_t>((digit((*s)[i]) << 4 | (digit((*s)[i + 1]) & 15)) & 0xFF));
        return bytes;
    };
    for (const auto& item : memory) {
        const std::string& name = item.first;
        const Value& value = item.second;
        const auto number = [&](std::size_t from) { return static_cast<std::uint16_t>(std::strtoul(name.c_str() + from, nullptr, 10)); };
        const auto bytes = bytes_of(value);
        if (name.starts_with("table.") && bytes.size() == 64) std::copy_n(bytes.begin(), 64, table_flash_[number(6)].begin());
        if (name.starts_with("curve.info.")) curves_flash_[number(11)].info = bytes;
        if (name.starts_with("curve.data.")) curves_flash_[number(11)].data = bytes;
    }
    start(now);
}

NonVolatile Device::non_volatile() const {
    NonVolatile all;
    drive_.memory.save(all);
    const auto hex = [](std::span<const std::uint8_t> bytes) {
        std::string s;
        for (const auto b : bytes) {
            s += "0123456789ABCDEF"[b >> 4];
            s += "0123456789ABCDEF"[b & 15];
        }
        return s;
    };
    for (const auto& [id, entry] : table_flash_)
        all["table." + std::to_string(id)] = hex(entry);
    for (const auto& [id, c] : curves_flash_) {
        all["curve.info." + std::to_string(id)] = hex(c.info);
        all["curve.data." + std::to_string(id)] = hex(c.data);
    }
    return all;
}

// --- telegrams --------------------------------------------------------------------------------------------------------------
void Device::on_frame(const Frame& frame, Instant now, Out& out) {
    if (frame.kind != Frame::Kind::bytes || !powered_) return;
    unasked(now, out);
    if (now < deaf_until_) return;
    if (!held_.empty() && now - last_byte_ > std::chrono::milliseconds(50)) held_.clear();  // the rest of a telegram has not arrived
    last_byte_ = now;
    held_.insert(held_.end(), frame.data().begin(), frame.data().end());
    look(now, out);
}

void Device::look(Instant now, Out& out) {
    const std::size_t tail = setup_.checksum == "none" ? 0 : 2;
    std::size_t at = 0;
    while (at + 4 <= held_.size()) {  // a restart clears held_
        const Data rest(held_.data() + at, held_.size() - at);
        const std::size_t n = rest[2];
        if (rest[0] != 1 || n < 2 || n > 63 || rest[3] != 2) {
            ++at;
            continue;
        }
        const std::size_t whole = n + 4 + tail;
        if (rest.size() < whole) break;
        const bool good = rest[whole - 1] == 4 && (tail == 0 || at16(rest, n + 3) == sum(rest.first(n + 3)));
        if (!good) {
            ++at;
            continue;
        }
        at += whole;
        if (rest[1] != setup_.id) continue;  // most telegrams of a full line
        const std::vector<std::uint8_t> body(rest.begin() + 4, rest.begin() + static_cast<std::ptrdiff_t>(n + 3));
        if (body.size() < 2 || !heeds(body[1], body.size() - 2, now)) continue;
        free_at_ = now + manners().request_pause;
        received(body, now, out);
    }
    held_.erase(held_.begin(), held_.begin() + static_cast<std::ptrdiff_t>(std::min(at, held_.size())));
}

/// Whether it takes a request: not too soon after the one before, and of the exact length if it insists on that.
bool Device::heeds(std::uint8_t main, std::size_t size, Instant now) const {
    if (now < free_at_) return false;
    if (!manners().exact_length) return true;
    return main == 0 ? size == 0 : main != 1 && main != 3 ? true : size == 2;
}

std::vector<std::uint8_t> Device::telegram(std::uint8_t id, std::span<const std::uint8_t> body) const {
    std::vector<std::uint8_t> t{1, id, static_cast<std::uint8_t>(body.size() + 1), 2};
    t.insert(t.end(), body.begin(), body.end());
    if (setup_.checksum != "none") put(t, sum(t), 2);
    t.push_back(4);
    return t;
}

void Device::send(std::span<const std::uint8_t> bytes, Instant at, Out& out, Priority priority) const {
    Frame frame = Frame::run(bytes);
    frame.at = at;
    out.send(frame, priority);
}

void Device::answer(std::uint8_t sub, std::vector<std::uint8_t> data, Out& out) const {
    if (silent_) return;
    data.insert(data.begin(), {sub, 0});
    send(telegram(setup_.id, data), at_, out);
}

/// Answers of jobs in the memory, which take some time.
void Device::answer_later(Duration time, const Out& answers) {
    for (const auto& tx : answers.frames) {
        if (slow_.size() >= most_slow) return;
        slow_.emplace_back(std::max(at_ + time, slow_.empty() ? at_ : slow_.back().first), tx.frame);
    }
}

/// Another master asks another drive, which answers: the number differs from the own one in its highest bit, so that it is hardly one of
/// the site.
void Device::speak_foreign(Instant at, Out& out) const {
    const auto id = static_cast<std::uint8_t>(setup_.id ^ 0x80);
    const std::array<std::uint8_t, 2> request{1, 0};
    std::vector<std::uint8_t> response{0, 0, Comm::ok, 0x37, 0x04, 0xC1, 0x08};
    put(response, static_cast<std::uint32_t>(ns_of(at) / 1'000'000), 4);
    std::vector<std::uint8_t> both = telegram(id, request);
    const auto answer = telegram(id, response);
    both.insert(both.end(), answer.begin(), answer.end());
    send(both, at, out, Priority::poll);
}

/// Everything that is sent without a request and is due.
void Device::unasked(Instant now, Out& out) {
    constexpr int most = 1000;  // in one call: a test that does not ask for hours does not receive all of them
    for (int i = 0; i < most && std::min(foreign_at_, unsolicited_at_) <= now; ++i) {
        if (foreign_at_ <= unsolicited_at_) {
            speak_foreign(foreign_at_, out);
            foreign_at_ += manners().foreign;
        } else {
            at_ = unsolicited_at_;
            advance(at_);
            Out own;
            if (at_ >= deaf_until_) default_response(own);
            for (const auto& tx : own.frames)
                out.send(tx.frame, Priority::poll);
            unsolicited_at_ += manners().unsolicited;
        }
    }
    while (!slow_.empty() && slow_.front().first <= now) {
        if (!silent_) send(slow_.front().second.data(), slow_.front().first, out);
        slow_.pop_front();
    }
}

void Device::default_response(Out& out, std::span<const std::uint8_t> more) const {
    const Words words = shown_.at(drive_, at_);
    const auto place = [](double v) {
        return static_cast<std::uint32_t>(static_cast<std::int32_t>(std::lround(std::clamp(v, -2147483648.0, 2147483647.0))));
    };
    std::vector<std::uint8_t> d{Comm::ok};
    put(d, words.status, 2);
    put(d, words.state_var, 2);
    const Content content = manners().content;
    if (content != Content::without_position) put(d, place(drive_.actual()), 4);
    if (content == Content::with_demand || content == Content::with_all) put(d, place(drive_.demand()), 4);
    if (content == Content::with_all) {
        put(d, drive_.ram(0x1B93), 2);
        put(d, words.warn, 2);
    }
    d.insert(d.end(), more.begin(), more.end());
    answer(0, std::move(d), out);
}

void Device::config(std::uint8_t sub, std::uint8_t state, std::uint16_t index, std::uint32_t value, Out& out) const {
    std::vector<std::uint8_t> d{state};
    put(d, index, 2);
    put(d, value, 4);
    answer(sub, std::move(d), out);
}

void Device::set_error_count() {
    const bool now_in_error = drive_.state() == error || drive_.state() == setup_error;
    if (now_in_error && drive_.error_code() != last_error_) ++errors_seen_;
    last_error_ = now_in_error ? drive_.error_code() : std::uint16_t{0};
}

void Device::received(Data body, Instant now, Out& out) {
    at_ = now;
    advance(now);
    const std::uint8_t sub = body[0], main = body[1];
    const Data data = body.subspan(2);
    switch (main) {
        case 0x00:
            if (sub == 3) {  // warn word and two bytes of unknown meaning follow: seen in public programs only
                if (manners().warn_answer == WarnAnswer::none) break;
                std::vector<std::uint8_t> more;
                put(more, shown_.at(drive_, at_).warn, manners().warn_answer == WarnAnswer::long_form ? 4 : 2);
                default_response(out, more);
            } else if (sub >= 1 && sub <= 4) {
                default_response(out);
            }
            break;
        case 0x01:
            if (sub != 0 || data.size() < 2) break;
            drive_.write_control_word(at16(data, 0), now);
            default_response(out);
            break;
        case 0x02:
            if (sub != 0 || data.size() < 2) break;
            drive_.write_motion_command(data, now);
            default_response(out);
            break;
        case 0x03:
            if (sub == 0 && data.size() >= 2 && manners().ram_access) {
                std::vector<std::uint8_t> more;
                put(more, drive_.ram(at16(data, 0)), 4);
                default_response(out, more);
            }
            break;
        case 0x04:
            curves(sub, data, out);
            break;
        case 0x05:
            parameters(sub, data, out);
            break;
        case 0x06:
            program(sub, now, out);
            break;
        case 0x07:
            errors(sub, data, out);
            break;
        case 0x08:
            command_table(sub, data, out);
            break;
        default:
            break;
    }
    set_error_count();
}

// --- time -------------------------------------------------------------------------------------------------------------------
Instant Device::deadline() const {
    if (!powered_) return never;
    return std::min({reply_at_, drive_.next_event(), foreign_at_, unsolicited_at_, slow_.empty() ? never : slow_.front().first});
}

void Device::on_deadline(Instant now, Out& out) {
    if (!powered_) return;
    unasked(now, out);
    advance(now);
    if (now >= reply_at_) {
        Frame frame = Frame::run(reply_);
        frame.at = reply_at_;
        reply_at_ = never;
        if (!silent_ && !reply_.empty()) out.send(frame);
    }
}

TwinMechanics Device::mechanics(int, Instant now) const {
    if (powered_) advance(now);
    const Point p = drive_.mechanics();
    return {p.position, p.velocity, powered_ && drive_.powered()};
}

}  // namespace axisgate::linmot::twin
