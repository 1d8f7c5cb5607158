// Comm: bytes to lines by the terminator of the mode, with echo and checksum as they go.
// In: bytes. Out: events.
// Never keeps more than one line: the 65th character ends it.
#include "adapters/mcode/twin/comm.hpp"

#include <utility>

namespace axisgate::mcode::twin {
namespace {

constexpr std::uint8_t ctrl_c = 0x03, ctrl_e = 0x05, ack = 0x06, backspace = 0x08, lf = 0x0A, cr = 0x0D, nak = 0x15, esc = 0x1B;

}  // namespace

void Comm::restart() noexcept {
    clear();
    armed_ = false;
}

void Comm::clear() noexcept {
    line_.clear();
    discarding_ = false;
}

bool Comm::addressed(char first) const noexcept { return first == flags.dn || first == '*' || (first == '^' && flags.qd); }

std::size_t Comm::pass_over(std::span<const std::uint8_t> bytes) {
    if (!flags.py || stepping_ || line_.empty() || discarding_ || (armed_ && addressed(line_[0]))) return 0;
    const std::size_t limit = line_limit + 1 + (flags.ck > 0 ? 1 : 0);
    const std::size_t room = limit > line_.size() ? limit - line_.size() : 0;
    std::size_t n = 0;
    while (n < bytes.size() && n < room && bytes[n] >= 0x20)
        ++n;
    line_.append(reinterpret_cast<const char*>(bytes.data()), n);
    return n;
}

/// Escape characters and CTRL+C act at once, wherever they stand [L861, L2741-2744].
LinkEvent Comm::interrupt(std::uint8_t byte) {
    const bool alone = line_.size() == 1 && addressed(line_[0]);
    clear();
    if (byte == ctrl_c) {
        const bool wanted = flags.ce == 1 || (flags.ce == 2 && (!flags.py || alone));
        return {wanted ? LinkEvent::Kind::reset : LinkEvent::Kind::none};
    }
    const bool wanted = (flags.es == 0 && byte == ctrl_e) || (flags.es == 1 && byte == esc) || (flags.es == 2 && byte == ctrl_e && alone) ||
                        (flags.es == 3 && byte == esc && alone);
    return {wanted ? LinkEvent::Kind::stop : LinkEvent::Kind::none};
}

LinkEvent Comm::receive(std::uint8_t byte, std::string& echo) {
    if (byte == esc || byte == ctrl_e || byte == ctrl_c) return interrupt(byte);
    if (stepping_ && line_.empty() && (byte == ' ' || byte == cr)) return {byte == ' ' ? LinkEvent::Kind::step : LinkEvent::Kind::run_on};
    const bool second_half = std::exchange(after_cr_, byte == cr);
    if (byte == (flags.py ? lf : cr) || (network && byte == lf && !second_half)) return finish(echo);
    if (byte == lf || byte == cr) return {};
    // On one pair of wires the answers of the neighbours are heard too: an acknowledgement ends theirs.
    if (flags.py && (byte == ack || byte == nak)) {
        clear();
        return {};
    }
    if (byte == backspace && !line_.empty()) {
        line_.pop_back();
        if (!flags.py && flags.em == 0 && !manners.echo_whole) echo += static_cast<char>(byte);
        return {};
    }
    if ((byte < 0x20 && byte != '\t') || discarding_) return {};
    return append(static_cast<char>(byte), echo);
}

bool Comm::echoes() const noexcept {
    if (flags.em != 0 || line_.empty()) return false;
    return !flags.py || (armed_ && addressed(line_[0]) && (line_[0] == flags.dn || !flags.dg));
}

/// A character of a line.
LinkEvent Comm::append(char c, std::string& echo) {
    if (flags.py && line_.empty() && (c == '>' || c == '?')) return {};  // a neighbour's prompt
    line_ += c;
    const bool mine = !flags.py || (armed_ && addressed(line_[0]));
    const bool quiet = flags.py && line_[0] != flags.dn && flags.dg;
    const bool name = flags.py && line_.size() == 1 && !manners.echo_name;
    if (!name && !manners.echo_whole && echoes()) echo += c;
    const std::size_t limit = line_limit + (flags.py ? 1 : 0) + (flags.ck > 0 ? 1 : 0);
    if (line_.size() <= limit) return {};
    clear();
    discarding_ = true;
    if (!mine || quiet) return {};
    echo += flags.em == 0 ? "\r\n?" : "\r\n";  // the prompt says that there is an error [L2696]
    return {LinkEvent::Kind::overrun};
}

LinkEvent Comm::finish(std::string& echo) {
    const bool was_discarding = discarding_;
    if (manners.echo_whole && echoes()) echo += flags.py && !manners.echo_name ? line_.substr(1) : line_;
    std::string line = std::move(line_);
    clear();
    if (flags.py && !armed_) {
        armed_ = true;
        return {};
    }
    if (was_discarding) return {};
    Command c;
    c.flags = flags;
    c.as_received = line;
    std::string_view rest = line;
    if (flags.py) {
        if (rest.empty() || !addressed(rest[0])) return {};
        c.silent = rest[0] != flags.dn && flags.dg;
    }
    if (flags.ck > 0 && !rest.empty()) {
        unsigned sum = 0;
        for (const char ch : rest)
            sum += static_cast<std::uint8_t>(ch);
        c.checksum_good = (sum & 0x7F) == 0;
        rest.remove_suffix(1);
    }
    if (flags.py && !rest.empty()) rest.remove_prefix(1);
    c.text = std::string(rest);
    command_ = std::move(c);
    return {LinkEvent::Kind::command};
}

char Comm::checksum(std::string_view text) noexcept {
    unsigned sum = 0;
    for (const char ch : text)
        sum += static_cast<std::uint8_t>(ch);
    return static_cast<char>(((0U - sum) & 0x7FU) | 0x80U);
}

Reply Comm::reply(const Command& c, std::optional<std::string_view> data, bool ended, bool good, bool pending, bool running) const {
    using Order = Manners::Order;
    Reply out;
    if (c.silent) return out;
    const bool sum = c.flags.ck > 0;
    const int em = c.flags.em;
    // The command as it came, without the name in front of it: tables 7.2 and 7.4 echo (command) where (DN) (command) was sent.
    if (em == 3) out.head += c.flags.py && !c.as_received.empty() && !manners.echo_name ? c.as_received.substr(1) : c.as_received;
    const Order order = em == 1 && data ? manners.answer_order : Order::acknowledged_first;
    if (em != 2 && order != Order::data_alone) {
        std::string& place = order == Order::data_first ? out.tail : out.head;
        if (!sum) {
            place += "\r\n";
        } else if (!(c.flags.ck == 2 && running && good)) {
            place += static_cast<char>(good ? ack : nak);
        }
    }
    if (data) {
        out.data = *data;
        if (sum) out.data += checksum(*data);
        if (ended) out.data += "\r\n";
    }
    if (em == 0) out.prompt = pending ? '?' : '>';
    return out;
}

std::uint32_t rate_of_code(int code) noexcept {
    switch (code) {
        case 48:
            return 4800;
        case 96:
            return 9600;
        case 19:
            return 19200;
        case 38:
            return 38400;
        case 11:
            return 115200;
        default:
            return 0;
    }
}

}  // namespace axisgate::mcode::twin
