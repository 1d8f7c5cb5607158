// The format is little-endian; a section is its name (4 bytes), its size (8), the SHA-256 of its data (32), its data. The bytes may have
// any origin; the size that a damaged field claims is never allocated.
#include "gateway/services/recorder/axr.hpp"

#include <fmt/core.h>
#include <sodium.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <optional>

namespace axisgate {
namespace {
constexpr std::size_t header_size = 16, section_head = 4 + 8 + 32;
using Sha256 = std::array<char, 32>;

Sha256 sha256_of(std::span<const char> data) {
    Sha256 h{};
    (void)crypto_hash_sha256(reinterpret_cast<unsigned char*>(h.data()), reinterpret_cast<const unsigned char*>(data.data()), data.size());
    return h;
}
std::uint64_t number_at(std::span<const char> in, std::size_t at, std::size_t size) {
    std::uint64_t v = 0;
    for (std::size_t i = 0; i < size; ++i)
        v |= std::uint64_t{static_cast<std::uint8_t>(in[at + i])} << (8 * i);
    return v;
}
std::string header_fault(std::span<const char> bytes) {
    if (bytes.size() < axr_magic.size() || !std::ranges::equal(bytes.first(axr_magic.size()), axr_magic))
        return "this is no recording of axisgate (.axr)";
    if (bytes.size() < header_size) return "the recording is cut off: it ends in its header";
    if (const auto version = number_at(bytes, 8, 2); version != axr_version)
        return fmt::format("the recording is of version {}; this program reads version {}", version, axr_version);
    return "";
}
/// The section that begins at `at`; empty if it is truncated.
std::optional<Axr::Section> section_at(std::span<const char> bytes, std::size_t at) {
    if (bytes.size() - at < section_head) return std::nullopt;
    const auto size = number_at(bytes, at + 4, 8);
    if (size > bytes.size() - at - section_head) return std::nullopt;
    return Axr::Section{{bytes.data() + at, 4}, bytes.subspan(at + section_head, static_cast<std::size_t>(size))};
}
bool whole(std::span<const char> bytes, std::size_t at, const Axr::Section& s) {
    return std::ranges::equal(bytes.subspan(at + 12, 32), sha256_of(s.data));
}
std::string printable(std::string_view name) {
    std::string text;
    for (const char c : name)
        text += c >= ' ' && c < 0x7F ? c : '?';
    return text;
}
}  // namespace

AxrWriter::AxrWriter() : out_(axr_magic) {
    out_.push_back(static_cast<char>(axr_version));
    out_.append(header_size - axr_magic.size() - 1, '\0');
}

void AxrWriter::begin(std::string_view name) {
    close();
    begins_ = out_.size();
    out_.append(name.substr(0, 4));
    out_.append(section_head - 4, '\0');
}

void AxrWriter::add(std::span<const char> part) { out_.append(part.data(), part.size()); }

void AxrWriter::close() {
    if (begins_ == 0) return;
    const auto data = std::span<const char>(out_).subspan(begins_ + section_head);
    const Sha256 hash = sha256_of(data);
    for (std::size_t i = 0; i < 8; ++i)
        out_[begins_ + 4 + i] = static_cast<char>(data.size() >> (8 * i));
    std::ranges::copy(hash, out_.begin() + static_cast<std::ptrdiff_t>(begins_ + 12));
    begins_ = 0;
}

std::string AxrWriter::finish() {
    close();
    const Sha256 all = sha256_of(out_);
    begin(axr_end);
    add(all);
    close();
    return std::move(out_);
}

std::span<const char> Axr::section(std::string_view name) const {
    const auto it = std::ranges::find(sections, name, &Section::name);
    return it == sections.end() ? std::span<const char>() : it->data;
}
bool Axr::has(std::string_view name) const { return std::ranges::find(sections, name, &Section::name) != sections.end(); }

Axr read_axr(std::span<const char> bytes) {
    Axr out;
    const auto wrong = [&out](std::string text) {
        out.sections.clear();
        out.fault = std::move(text);
        return std::move(out);
    };
    if (auto fault = header_fault(bytes); !fault.empty()) return wrong(std::move(fault));
    std::size_t at = header_size;
    for (;;) {
        const auto s = section_at(bytes, at);
        if (!s)
            return wrong(out.sections.empty()
                             ? "the recording is cut off behind its header"
                             : fmt::format("the recording is cut off behind its section {}", printable(out.sections.back().name)));
        if (!whole(bytes, at, *s))
            return wrong(fmt::format("the recording was altered: its section {} does not match its hash", printable(s->name)));
        if (s->name == axr_end) {
            if (!std::ranges::equal(s->data, sha256_of(bytes.first(at))))
                return wrong("the recording was altered: its last hash does not match");
            if (at + section_head + s->data.size() != bytes.size()) return wrong("the recording was altered: something follows its end");
            break;
        }
        out.sections.push_back(*s);
        at += section_head + s->data.size();
    }
    if (!out.has(axr_meta) || (!out.has(axr_records) && !out.has(axr_capture) && !out.has(axr_trends)))
        return wrong("the recording lacks a section that each one has");
    return out;
}

std::string_view axr_head(std::span<const char> bytes, std::string& fault) {
    fault = header_fault(bytes);
    if (!fault.empty()) return {};
    const auto s = section_at(bytes, header_size);
    if (!s || s->name != axr_meta)
        fault = "the recording is cut off behind its header";
    else if (!whole(bytes, header_size, *s))
        fault = "the recording was altered: its section META does not match its hash";
    return fault.empty() ? std::string_view(s->data.data(), s->data.size()) : std::string_view();
}

std::string check_recording_name(std::string_view name) {
    const bool letters = std::ranges::all_of(name, [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' || c == '_' || c == '.';
    });
    if (name.empty() || name.size() > 64 || !letters || name.front() == '.')
        return "a name has 1 to 64 letters, digits, - _ or . and does not begin with a dot";
    return "";
}

}  // namespace axisgate
