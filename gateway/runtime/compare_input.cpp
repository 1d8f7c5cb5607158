// Times may step back by a millisecond, because interfaces are read one after the other; a larger step means that the file was put together
// from several recordings.
#include "gateway/runtime/compare_input.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <set>

#include "gateway/core/specimen.hpp"
#include "gateway/runtime/recording.hpp"
#include "gateway/services/parameters/memory_file.hpp"
#include "gateway/site/options.hpp"

namespace axisgate {
namespace {

struct Loaded {
    std::vector<SeenFrame> frames;
    std::string fault;
};

/// The frames of one line of the recording, with their instants since its first frame.
Loaded load(const CompareOptions& o, std::string_view bytes, RecordingFormat format) {
    Loaded out;
    std::set<std::string> lines;
    std::optional<std::int64_t> first, last;
    std::size_t number = 0;
    const auto wrong = [&out](std::string text) {
        if (out.fault.empty()) out.fault = std::move(text);
    };
    RecordingEvents events;
    events.frame = [&](const RecordedFrame& r) {
        ++number;
        if (!out.fault.empty() || (!o.interface.empty() && r.line != o.interface)) return;
        lines.insert(r.line);
        if (!r.at_ns)
            return wrong(
                fmt::format("frame {} has no time, so reply times cannot be compared: record with `candump -L`, or write (SECONDS) in "
                            "front of each line of bytes",
                            number));
        if (!r.to_drive && r.frame.kind == Frame::Kind::bytes)
            return wrong(
                fmt::format("frame {} has no direction: write > in front of bytes to the drive and < in front of those from it", number));
        if (!first) first = last = r.at_ns;
        constexpr std::int64_t most_back_ns = 1'000'000;
        if (*r.at_ns < saturated_difference(*last, most_back_ns))
            return wrong(
                fmt::format("the time steps back at frame {}: the recording is put together from several, or the clock was set", number));
        last = std::max(*last, *r.at_ns);
        constexpr std::int64_t longest_ns = std::chrono::nanoseconds(std::chrono::hours(31 * 24)).count();
        if (saturated_difference(*last, *first) > longest_ns)
            return wrong(
                fmt::format("frame {} is more than 31 days behind the first one: the recording is put together from several, or the "
                            "clock was set",
                            number));
        if (out.frames.size() == ComparisonInput::most_frames)
            return wrong(fmt::format("the recording has more than {} frames: compare a part of it", ComparisonInput::most_frames));
        SeenFrame& f = out.frames.emplace_back(SeenFrame{r.frame, r.to_drive});
        f.frame.at = time_zero + Duration(*last - *first);
    };
    events.fault = [&](std::size_t place, const std::string& text) {
        wrong(fmt::format("{}: {}", recording_place(o.file, format, place), text));
    };
    read_recording(bytes, format, events);
    const bool text = format == RecordingFormat::candump || format == RecordingFormat::hex;
    if (text && !bytes.empty() && bytes.back() != '\n')
        out.fault = fmt::format("{} is cut in its last line: if the recording is complete, add the line end that is missing", o.file);
    if (!out.fault.empty()) return out;
    if (out.frames.empty()) {
        wrong(o.interface.empty() ? fmt::format("{} contains no frames", o.file)
                                  : fmt::format("{} contains no frames of the interface {}", o.file, o.interface));
    } else if (lines.size() > 1) {
        std::string names;
        for (const auto& l : lines)
            names += (names.empty() ? "" : ", ") + l;
        wrong(fmt::format("{} contains several lines: choose one with --interface: {}", o.file, names));
    }
    return out;
}

std::string take_options(ComparisonInput& input, const CompareOptions& o) {
    for (const auto& x : o.options) {
        const auto equals = x.find('=');
        if (equals == std::string::npos || equals == 0) return "--option: write NAME=VALUE";
        const std::string name = x.substr(0, equals), value = x.substr(equals + 1);
        if (name == "specimen") return "--option: use --specimen to compare with one specimen only";
        if (const std::string wrong = check_option(*input.page, {OptionOf::twin}, name, value); !wrong.empty()) return "--option: " + wrong;
        input.options[name] = value;
    }
    if (!o.specimen.empty()) {
        if (const std::string wrong = check_specimen(o.specimen); !wrong.empty()) return "--specimen: " + wrong;
        input.specimens = {o.specimen};
        return {};
    }
    input.specimens.emplace_back("0");
    for (const auto name : named_specimens)
        input.specimens.emplace_back(name);
    for (int seed = 1; seed <= o.seeds; ++seed)
        input.specimens.push_back(std::to_string(seed));
    return {};
}

/// Addresses of the command line, or those that a CAN recording shows, or the factory's.
std::string take_addresses(ComparisonInput& input, const CompareOptions& o, std::span<const SeenFrame> frames) {
    const Family& family = *input.family;
    for (const auto& a : o.addresses) {
        if (const std::string wrong = family.check_address(a); !wrong.empty()) return "--address: " + wrong;
        if (std::ranges::count(o.addresses, a) > 1) return fmt::format("--address: {} is there twice", a);
    }
    const auto found = input.kind == LineKind::can ? addresses_in(family, *input.page, frames) : std::vector<std::string>();
    std::string names;
    for (const auto& a : found)
        names += (names.empty() ? "" : ", ") + a;
    input.addresses = o.addresses;
    if (input.kind == LineKind::can && input.addresses.empty()) {
        if (found.empty())
            return fmt::format("{} has no frame that a drive of {} sends: it is of another family or another line", o.file, family.name);
        constexpr std::size_t most = 8;
        if (found.size() > most) return fmt::format("{} has frames of many drives: choose some with --address: {}", o.file, names);
        input.addresses = found;
    }
    if (input.addresses.empty()) input.addresses.emplace_back(family.factory_address);
    for (const auto& a : input.addresses) {
        if (input.kind == LineKind::can && std::ranges::find(found, a) == found.end())
            return fmt::format("{} has no frame of a drive of {} at address {}; it has frames of: {}", o.file, family.name, a,
                               found.empty() ? "none" : names);
    }
    return {};
}
}  // namespace

std::optional<ComparisonInput> comparison_input(const Families& families, const CompareOptions& o, std::string_view bytes,
                                                std::string_view state, std::string& fault) {
    ComparisonInput input;
    const auto entry = families.find(o.family);
    input.family = entry.family;
    input.page = entry.catalogue;
    if (!entry.family) {
        fault = fmt::format("there is no family {}; families: {}", o.family, families.names());
        return std::nullopt;
    }
    const auto named = recording_format_named(o.format);
    if (!o.format.empty() && !named) {
        fault = fmt::format("there is no format {}; formats: candump, hex, trace, pcapng, axr", o.format);
        return std::nullopt;
    }
    input.tolerance = std::chrono::milliseconds(o.tolerance_ms);
    fault = take_options(input, o);
    if (!fault.empty()) return std::nullopt;
    if (fault = memories_from_json(state, input.memories); !fault.empty()) {
        fault = fmt::format("--state {}: {}", o.state_file, fault);
        return std::nullopt;
    }
    auto loaded = load(o, bytes, named.value_or(recording_format_of(bytes)));
    fault = std::move(loaded.fault);
    if (!fault.empty()) return std::nullopt;
    const bool bytes_line = loaded.frames.front().frame.kind == Frame::Kind::bytes;
    const auto other = [&](const SeenFrame& f) { return (f.frame.kind == Frame::Kind::bytes) != bytes_line; };
    input.kind = bytes_line ? LineKind::bytes : LineKind::can;
    if (std::ranges::any_of(loaded.frames, other))
        fault = fmt::format("{} contains CAN frames and runs of bytes: choose one line with --interface", o.file);
    else if (!(bytes_line ? entry.family->uses_bytes : entry.family->uses_can))
        fault = fmt::format("{} contains {}, which drives of {} do not have: it is of another family", o.file,
                            bytes_line ? "runs of bytes" : "CAN frames", o.family);
    else
        fault = take_addresses(input, o, loaded.frames);
    if (!fault.empty()) return std::nullopt;
    if (bytes_line) input.bit_rate = entry.family->default_bit_rate;
    input.frames = with_directions(input, loaded.frames);
    fault = check_family(families, input);
    if (!fault.empty()) return std::nullopt;
    return input;
}

}  // namespace axisgate
