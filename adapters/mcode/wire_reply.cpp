// Framing: the search for a mark, for ACK and NAK, for a prompt, in what has come so far; looked at anew with each run of bytes.
// In: runs of bytes. Out: a verdict, and the data between mark and end.
// Never looks further than the present question.
#include "adapters/mcode/wire_reply.hpp"

#include <algorithm>

#include "adapters/mcode/wire.hpp"

namespace axisgate::mcode {
namespace {
bool is_prompt(char c) noexcept { return c == '>' || c == '?'; }
}  // namespace

void ReplyReader::begin(Expect expect) {
    expect_ = std::move(expect);
    raw_.clear();
    data_.clear();
    before_.clear();
    behind_.clear();
    block_.clear();
    asked_.clear();
    close_from_ = 0;
    closing_ = overflowed_ = false;
    maybe_refused_ = awaits_trailing_ = false;
    acknowledgement_ = AckPlace::none;
}

void ReplyReader::close_with(std::string mark, std::string sent) {
    if (!closing_) close_from_ = raw_.size();
    closing_ = true;
    expect_.mark = std::move(mark);
    asked_.push_back(std::move(sent));
}

Verdict ReplyReader::push(std::string_view bytes) {
    raw_ += bytes;
    if (raw_.size() > limit) {
        const std::size_t lost = raw_.size() - limit;
        raw_.erase(0, lost);
        close_from_ -= std::min(close_from_, lost);
        overflowed_ = true;
    }
    return look(false);
}

Verdict ReplyReader::give_up() { return look(true); }

Verdict ReplyReader::look(bool over) {
    switch (expect_.kind) {
        case Expect::Kind::block:
            if (expect_.ends) return look_for_end(over);
            break;
        case Expect::Kind::nothing:
            break;
        case Expect::Kind::command:
            return look_for_acknowledgement(over);
        case Expect::Kind::query:
            return look_for_data(over);
    }
    return over ? Verdict::answered : Verdict::waiting;
}

Verdict ReplyReader::look_for_acknowledgement(bool over) {
    const std::string_view all = raw_;
    const std::size_t width = expect_.checksum ? 1 : 2;
    const auto at = expect_.checksum ? all.find_first_of("\x06\x15") : find_bare_end(all);
    if (at == std::string_view::npos) return Verdict::waiting;
    const bool prompted = is_prompt(all.back()) && (!expect_.checksum || at + 1 < all.size());
    if (expect_.prompt && !over && !prompted) return Verdict::waiting;
    before_ = all.substr(0, at);
    behind_ = all.substr(at + width);
    if (expect_.checksum) return all[at] == ack ? Verdict::acknowledged : Verdict::refused;
    return expect_.prompt && all.back() == '?' ? Verdict::refused : Verdict::acknowledged;
}

/// Where the data begin: an echo of the request holds the mark too, but closed by its quote.
std::size_t ReplyReader::find_mark() const {
    const std::string_view all = raw_;
    std::size_t at = all.find(expect_.mark);
    while (at != std::string_view::npos && at + expect_.mark.size() < all.size() && all[at + expect_.mark.size()] == '"')
        at = all.find(expect_.mark, at + 1);
    return at != std::string_view::npos && at + expect_.mark.size() < all.size() ? at : std::string_view::npos;
}

/// The first CR LF that ends no text but the echo: an acknowledgement. One behind a text belongs to the output of a program, which may come
/// at any time. One or two characters before it are noise.
std::size_t ReplyReader::find_bare_end(std::string_view text) const {
    constexpr std::size_t shortest_text = 3;
    const std::string_view nameless = std::string_view(expect_.sent).substr(expect_.sent.empty() ? 0 : 1);
    for (std::size_t from = 0, at = text.find("\r\n"); at != std::string_view::npos; from = at + 2, at = text.find("\r\n", from)) {
        const std::string_view line = text.substr(from, at - from);
        const auto shown = std::ranges::count_if(line, [](char c) { return c >= 0x20 && c <= 0x7E && !is_prompt(c); });
        if (static_cast<std::size_t>(shown) < shortest_text || (!nameless.empty() && line.find(nameless) != std::string_view::npos))
            return at;
    }
    return std::string_view::npos;
}

AckPlace ReplyReader::find_acknowledgement(std::string_view before, std::string_view behind) const {
    const auto in = [&](std::string_view text) {
        return (expect_.checksum ? text.find(ack) : find_bare_end(text)) != std::string_view::npos;
    };
    return in(before) ? AckPlace::before : in(behind) ? AckPlace::behind : AckPlace::none;
}

/// Where the line end behind the data is.
std::size_t ReplyReader::find_end(std::size_t mark) const {
    const std::string_view all = raw_;
    if (!expect_.end_mark) return all.find("\r\n", mark);
    for (auto e = all.find(end_of_data, mark); e != std::string_view::npos; e = all.find(end_of_data, e + 1)) {
        const auto line_end = all.find("\r\n", e);
        if (line_end != std::string_view::npos && line_end - e <= 2) return line_end;
    }
    return std::string_view::npos;
}

Verdict ReplyReader::look_without_mark(bool over) {
    const std::string_view all = raw_;
    const bool refused = all.find(nak) != std::string_view::npos;
    if (refused && expect_.checksum) {
        maybe_refused_ = true;
        return over ? Verdict::refused : Verdict::waiting;
    }
    const bool reported = find_bare_end(all) != std::string_view::npos;
    if (reported && expect_.prompt && all.back() == '?') return Verdict::refused;
    return over && (refused || (reported && !expect_.checksum)) ? Verdict::refused : Verdict::waiting;
}

Verdict ReplyReader::look_for_data(bool over) {
    const std::string_view all = raw_;
    const std::size_t at = find_mark();
    if (at == std::string_view::npos) return look_without_mark(over);
    const std::size_t end = find_end(at);
    if (end == std::string_view::npos) return Verdict::waiting;
    if (expect_.prompt && !over && !is_prompt(all.back())) return Verdict::waiting;
    std::string_view part = all.substr(at, end - at);
    const bool summed = static_cast<std::uint8_t>(part.back()) >= 0x80 && checksum_good(part);
    if (expect_.checksum && !summed) return Verdict::garbled;
    if (summed) part.remove_suffix(1);
    part.remove_prefix(expect_.mark.size());
    if (expect_.end_mark) {
        if (part.empty() || part.back() != end_of_data) return Verdict::garbled;
        part.remove_suffix(1);
    }
    const auto unprintable = [](char c) { return (c < 0x20 && c != cr && c != lf && c != '\t') || static_cast<std::uint8_t>(c) > 0x7E; };
    if (std::ranges::any_of(part, unprintable)) return Verdict::garbled;
    data_ = part;
    behind_ = all.substr(end + 2);
    before_ = all.substr(0, at);
    acknowledgement_ = find_acknowledgement(before_, behind_);
    awaits_trailing_ = expect_.trailing && acknowledgement_ == AckPlace::none;
    return awaits_trailing_ && !over ? Verdict::waiting : Verdict::answered;
}

/// The closing answer stands at the beginning of a line: text of the block may hold the same characters elsewhere.
Verdict ReplyReader::look_for_end(bool over) {
    if (!closing_) return Verdict::waiting;
    const std::string_view all = raw_;
    const auto begins = [&](std::size_t i) {
        return i == close_from_ || static_cast<std::uint8_t>(all[i - 1]) < 0x20 || is_prompt(all[i - 1]);
    };
    auto at = all.find(expect_.mark, close_from_);
    while (at != std::string_view::npos && (!begins(at) || (at + expect_.mark.size() < all.size() && all[at + expect_.mark.size()] == '"')))
        at = all.find(expect_.mark, at + 1);
    const auto end = at == std::string_view::npos ? at : all.find("\r\n", at);
    if (end == std::string_view::npos) return Verdict::waiting;
    if (expect_.prompt && !over && !is_prompt(all.back())) return Verdict::waiting;
    std::string_view part = all.substr(at, end - at);
    const bool summed = static_cast<std::uint8_t>(part.back()) >= 0x80 && checksum_good(part);
    if (expect_.checksum && !summed) return Verdict::garbled;
    if (summed) part.remove_suffix(1);
    data_ = part.substr(expect_.mark.size());
    block_ = all.substr(0, at);
    for (const std::string& asked : asked_) {
        // A drive gives a line back without its name [L6840-6860], a converter with it.
        std::string_view echo = asked;
        auto found = block_.find(echo, std::min(close_from_, block_.size()));
        if (found == std::string::npos && !echo.empty()) {
            echo.remove_prefix(1);
            found = block_.find(echo, std::min(close_from_, block_.size()));
        }
        if (found != std::string::npos && !echo.empty()) block_.erase(found, echo.size());
    }
    behind_ = all.substr(end + 2);
    return Verdict::answered;
}

bool ReplyReader::taken_without_answer() const {
    if (expect_.kind != Expect::Kind::query) return false;
    std::string rest = raw_;
    const auto control = [&](std::size_t i) { return static_cast<std::uint8_t>(rest[i]) < 0x20; };
    // Echoes, by the drive or by a converter: from the name of a party line to the end of the line, its checksum included.
    const std::string asked = "PR \"" + expect_.mark + '"';
    for (auto at = rest.find(asked); at != std::string::npos; at = rest.find(asked)) {
        auto end = at;
        while (end < rest.size() && !control(end))
            ++end;
        if (at > 0 && !control(at - 1)) --at;
        rest.erase(at, end - at);
    }
    const std::string_view end_of_line = expect_.checksum ? "\x06" : "\r\n";
    return rest.find(end_of_line) != std::string::npos && rest.find_first_not_of("\r\n\x06>?") == std::string::npos &&
           (expect_.checksum || rest.find(ack) == std::string::npos);
}

bool block_sums_good(std::string_view raw) {
    const auto ended = raw.find(ack);
    if (ended == std::string_view::npos) return true;  // the echo's checksum is not the drive's word
    raw.remove_prefix(ended + 1);
    const auto is_sum = [](char c) { return static_cast<std::uint8_t>(c) >= 0x80; };
    const auto last = std::find_if(raw.rbegin(), raw.rend(), is_sum);
    const auto between_lines = [](std::string_view s) {
        return s.find_first_not_of(std::string_view("\r\n\x06\x15>?\0", 7)) == std::string_view::npos;
    };
    if (last == raw.rend()) return between_lines(raw);
    const auto size = static_cast<std::size_t>(raw.rend() - last);
    if (!between_lines(raw.substr(size))) return false;  // a line end that became something else, or noise behind it
    if (checksum_good(raw.substr(0, size))) return true;
    for (std::size_t from = 0; from < size;) {
        const auto end = std::min(raw.find("\r\n", from), size);
        if (end > from && !(is_sum(raw[end - 1]) && checksum_good(raw.substr(from, end - from)))) return false;
        from = end + 2;
    }
    return true;
}

std::string plain_text(std::string_view raw, std::string_view sent, bool with_checksum) {
    std::string s(raw);
    // An echo stands at the beginning of a line and ends it; the request may be as short as L, a letter of many answers. A drive gives it
    // back without its name [L6840-6860], a converter with it.
    const bool named = s.find(sent) == std::string::npos && sent.size() > 1 && s.starts_with(sent.substr(1));
    if (named) sent.remove_prefix(1);
    for (auto at = sent.empty() ? std::string::npos : s.find(sent); at != std::string::npos; at = s.find(sent, at + 1)) {
        const auto end = at + sent.size();
        const auto control = [&](std::size_t i) { return static_cast<std::uint8_t>(s[i]) < 0x20; };
        if ((at > 0 && !control(at - 1)) || (end < s.size() && !control(end))) continue;
        s.erase(at, sent.size());
        break;
    }
    std::erase_if(s, [&](char c) { return c == ack || c == nak || c == '\0' || (with_checksum && static_cast<std::uint8_t>(c) >= 0x80); });
    const auto outer = [](char c) { return c == cr || c == lf; };
    while (!s.empty() && (outer(s.back()) || (is_prompt(s.back()) && (s.size() == 1 || outer(s[s.size() - 2])))))
        s.pop_back();
    while (!s.empty() && outer(s.front()))
        s.erase(0, 1);
    return s;
}

}  // namespace axisgate::mcode
