// Fuzz target for makers' descriptions, from the file to the drive's catalogue, its model and its DCF. Laws: a file is accepted as a whole
// or refused with lines; an accepted one makes a catalogue or a fault of the site; the catalogue's points have a type, a range and names
// that lead back; the model answers.
#include <memory>

#include "gateway/core/text.hpp"
#include "gateway/core/twin.hpp"
#include "gateway/services/descriptions/description.hpp"
#include "tests/fuzz/fuzz.hpp"

using namespace axisgate;
using fuzz::require;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    Description d{{"a.eds", std::string(reinterpret_cast<const char*>(data), size)}, "me", 1};
    const auto read = descriptions::read(d.text);
    require(read.eds.has_value() == read.faults.empty(), "a description, or faults");
    const auto facts = descriptions::facts(d, read);
    require((facts != nullptr) == read.eds.has_value(), "facts of what is taken");
    for (const auto& f : descriptions::faults_of(read))
        require(!f.text.empty() && is_utf8(f.text), "a fault has words");
    if (!read.eds) return 0;
    require(is_utf8(json_text(*facts)), "facts are shown");
    const auto family = fuzz::families().find("cia402");
    const auto own = family.family->own_catalogue({*family.catalogue, {}, &d});
    require((own.catalogue != nullptr) == own.fault.empty(), "a catalogue, or a fault of the site");
    if (!own.catalogue) return 0;
    const Catalogue& c = *own.catalogue;
    AxisSnapshot snapshot;
    for (std::size_t i = 0; i < c.parameters().size(); ++i) {
        const Parameter& p = c.parameters()[i];
        require(!p.id.empty() && !p.name.empty() && is_utf8(p.description), "a parameter has names");
        const Point point{static_cast<std::uint16_t>(i), p.count == 0 ? std::uint16_t{0} : p.first};
        require(c.find(c.id_of(point)) == point, "its id leads back");
        if (known(p.factory_default)) snapshot.parameters.push_back({c.id_of(point), p.factory_default});
    }
    const auto dcf = descriptions::dcf_of(*read.eds, c, snapshot, 5, "drive", 500'000);
    require(descriptions::read(dcf.text).eds.has_value(), "a DCF of it is a description");
    TwinSetup setup;
    setup.address = "5";
    setup.kind = LineKind::can;
    setup.bit_rate = 1'000'000;
    const auto twin = family.family->make_twin(c, setup);
    Out out;
    twin->power_on({}, at_ns(0), out);
    // Every parameter of the catalogue is read once, so that the dictionary made of the file is used.
    Instant now = at_ns(1'000'000'000);
    std::size_t answers = 0;
    for (std::size_t i = 0; i < c.parameters().size() && i < 200; ++i) {
        const auto& wire = c.parameters()[i].wire;
        const auto index = static_cast<std::uint16_t>(wire.at("index").as_int64());
        Frame ask;
        ask.kind = Frame::Kind::can;
        ask.id = 0x605;
        const std::uint8_t bytes[8] = {0x40, static_cast<std::uint8_t>(index & 0xFF), static_cast<std::uint8_t>(index >> 8),
                                       static_cast<std::uint8_t>(wire.at("sub").as_int64())};
        ask.assign(bytes);
        ask.at = now;
        twin->on_frame(ask, now, out);
        now += std::chrono::milliseconds(10);
        if (twin->deadline() <= now) twin->on_deadline(now, out);
        for (const auto& sent : out.frames)
            if (sent.frame.kind == Frame::Kind::can && sent.frame.id == 0x585) ++answers;
        out.frames.clear();
    }
    require(c.parameters().empty() || answers > 0, "the model answers");
    return 0;
}
