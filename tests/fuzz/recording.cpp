// Fuzz target for `axisgate decode` and `axisgate compare`: a recording in any of its forms, through every family's decoder. Laws: one line
// per message, frames that fit their kind, and frames that were read can be written and read again.
#include "gateway/runtime/recording.hpp"

#include "gateway/wire/frame_export.hpp"
#include "tests/fuzz/fuzz.hpp"

using namespace axisgate;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size == 0 || size > 64 * 1024) return 0;
    const auto format = static_cast<RecordingFormat>(data[0] % 5);
    const std::string_view text(reinterpret_cast<const char*>(data) + 1, size - 1);
    struct Pair {
        std::unique_ptr<Decoder> can, bytes;
    };
    std::vector<Pair> decoders;
    for (const auto& e : fuzz::families().entries) {
        decoders.push_back({e.family->make_decoder(*e.catalogue, LineKind::can), e.family->make_decoder(*e.catalogue, LineKind::bytes)});
    }
    const auto one_line_each = [](const std::vector<std::string>& lines) {
        for (const auto& l : lines)
            fuzz::require(!l.empty() && l.find('\n') == std::string::npos, "a decoded message is one line");
    };
    std::vector<TraceEntry> entries;
    RecordingEvents events;
    events.frame = [&](const RecordedFrame& r) {
        const Frame& f = r.frame;
        fuzz::require(f.kind == Frame::Kind::bytes ? f.size > 0 : f.size <= 8, "a frame holds what its kind can hold");
        fuzz::require(f.id <= 0x1FFFFFFFu, "an identifier has 29 bits");
        for (auto& d : decoders) {
            // A run of bytes on a CAN line and the reverse: a recording of another line.
            one_line_each(d.can->on_frame(f, r.to_drive));
            one_line_each(d.bytes->on_frame(f, r.to_drive));
        }
        TraceEntry e;
        e.frame = f;
        if (f.kind == Frame::Kind::can) e.frame.extended = f.extended || f.id > 0x7FF;  // the trace form cannot represent impossible frames
        e.to_drive = r.to_drive.value_or(false);
        entries.push_back(std::move(e));
    };
    std::size_t faults = 0;
    events.fault = [&](std::size_t, const std::string& what) {
        ++faults;
        fuzz::require(!what.empty() && what.size() < 200, "a fault is a short sentence");
    };
    read_recording(text, format, events);
    fuzz::require(faults + entries.size() <= size + 1, "no more comes out than went in");
    for (auto& d : decoders) {
        one_line_each(d.can->finish());
        one_line_each(d.bytes->finish());
    }
    std::size_t again = 0;
    RecordingEvents second;
    second.frame = [&](const RecordedFrame& r) {
        fuzz::require(again < entries.size(), "not more is read than was written");
        const Frame& f = entries[again++].frame;
        fuzz::require(to_text(f) == to_text(r.frame) && r.to_drive.has_value(), "what was written is read back");
    };
    second.fault = [](std::size_t, const std::string&) { fuzz::require(false, "what was written can be read"); };
    read_recording(trace_text(entries, "line"), RecordingFormat::candump, second);
    fuzz::require(again == entries.size(), "everything is read back");
    return 0;
}
