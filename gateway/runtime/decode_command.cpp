// Converts a recorded line to readable exchanges, one line per message: a candump log, hex lines, a trace as JSON, a capture or a
// recording; from a file or standard input. Lines that cannot be read are reported with their place.
#include <fmt/core.h>

#include <cstdio>

#include "gateway/runtime/catalogues.hpp"
#include "gateway/runtime/commands.hpp"
#include "gateway/runtime/files.hpp"
#include "gateway/runtime/recording.hpp"

namespace axisgate {

int command_decode(const std::string& family, const std::string& format_name, const std::string& file) {
    std::vector<std::string> faults;
    const auto families = load_families(faults);
    for (const auto& f : faults)
        complain(f);
    if (!faults.empty()) return exit_failed;
    const auto entry = families.find(family);
    if (!entry.family) {
        complain(fmt::format("there is no family {}; families: {}", family, families.names()));
        return exit_usage;
    }
    const auto format = recording_format_named(format_name);
    if (!format) {
        complain(fmt::format("there is no format {}; formats: candump, hex, trace, pcapng, axr", format_name));
        return exit_usage;
    }
    std::string fault;
    const auto text = read_file(file, fault);
    if (!text) {
        complain(fault);
        return exit_failed;
    }
    const auto can = entry.family->make_decoder(*entry.catalogue, LineKind::can);
    const auto bytes = entry.family->make_decoder(*entry.catalogue, LineKind::bytes);
    bool good = true;
    RecordingEvents events;
    events.frame = [&](const RecordedFrame& r) {
        Decoder& decoder = r.frame.kind == Frame::Kind::bytes ? *bytes : *can;
        for (const auto& line : decoder.on_frame(r.frame, r.to_drive))
            fmt::print("{}{}{}\n", r.stamp, r.stamp.empty() ? "" : " ", line);
    };
    events.fault = [&](std::size_t place, const std::string& what) {
        complain(fmt::format("{}: {}", recording_place(file, *format, place), what));
        good = false;
    };
    read_recording(*text, *format, events);
    for (Decoder* d : {can.get(), bytes.get()}) {
        for (const auto& line : d->finish())
            fmt::print("{}\n", line);
    }
    return good ? exit_good : exit_failed;
}

}  // namespace axisgate
