// Options that cannot be read have their factory values.
#include "adapters/linmot/twin/twin.hpp"

#include <algorithm>
#include <charconv>

#include "adapters/linmot/twin/device.hpp"
#include "gateway/core/catalogue.hpp"

namespace axisgate::linmot::twin {
namespace {
std::uint32_t number(std::string_view text, std::uint32_t most, std::uint32_t otherwise, int base = 10) {
    std::uint32_t n = 0;
    const auto [end, ec] = std::from_chars(text.data(), text.data() + text.size(), n, base);
    return ec == std::errc{} && end == text.data() + text.size() && n <= most ? n : otherwise;
}
double place(std::string_view text, double otherwise) {
    double n = 0;
    const auto [end, ec] = std::from_chars(text.data(), text.data() + text.size(), n);
    return ec == std::errc{} && end == text.data() + text.size() && n >= -2e9 && n <= 2e9 ? n : otherwise;
}
/// "left,right,end left,end right,start ratio,end ratio,revolutions,disturbance length,disturbance stroke[,antiparallel]".
Winding winding_of(std::string_view text) {
    Winding w;
    for (double* into : {&w.left, &w.right, &w.end_left, &w.end_right, &w.start_ratio, &w.end_ratio, &w.revolutions, &w.disturbance_length,
                         &w.disturbance_stroke}) {
        const auto word = text.substr(0, text.find(','));
        *into = place(word, *into);
        text.remove_prefix(std::min(text.size(), word.size() + 1));
    }
    w.antiparallel = text == "antiparallel";
    return w;
}
}  // namespace

std::unique_ptr<Twin> make_twin(const Catalogue& catalogue, const TwinSetup& setup) {
    DeviceSetup d;
    d.id = static_cast<std::uint8_t>(number(setup.address, 255, 17));
    d.checksum = option(setup.options, "checksum", "none");
    if (d.checksum != "sum" && d.checksum != "crc" && d.checksum != "crc_reflected") d.checksum = "none";
    d.checksum_from = number(option(setup.options, "checksum_from", "0"), 3, 0);
    d.checksum_start = static_cast<std::uint16_t>(number(option(setup.options, "checksum_start", "FFFF"), 0xFFFF, 0xFFFF, 16));
    if (option(setup.options, "series", "e1100") == "b1100") d.drive.series = Series::b1100;
    const std::string keys = option(setup.options, "keys", "both");
    d.drive.curve_key = keys == "both" || keys == "curve";
    d.drive.force_key = keys == "both" || keys == "force";
    d.drive.force_mask = d.drive.force_word = static_cast<std::uint16_t>(number(option(setup.options, "force", "0"), 0xFFFF, 0));
    d.drive.keeps_braking_error = option(setup.options, "braking_error", "kept") != "lost";
    d.drive.trig_rise = place(option(setup.options, "trig_rise", ""), d.drive.trig_rise);
    d.drive.trig_fall = place(option(setup.options, "trig_fall", ""), d.drive.trig_fall);
    d.drive.winding = winding_of(option(setup.options, "winding", ""));
    d.drive.manners = Manners(setup.freedoms);
    d.drive.seed = setup.seed;
    for (const ErrorCode& e : catalogue.errors()) {
        std::string_view kind = "Err: ";
        if (e.kind == "fatal_error") kind = "Fatal Err: ";
        if (e.kind == "setup_error") kind = "Setup Err: ";
        if (e.kind == "runtime_error") kind = "Runtime Err: ";
        if (e.kind == "configuration_error" || e.kind == "fatal_configuration_error") kind = "Cfg Err: ";
        if (e.kind == "user_error") kind = "User Err: ";
        d.error_texts[static_cast<std::uint16_t>(e.code)] = std::string(kind) + e.text;
    }
    return std::make_unique<Device>(std::move(d));
}

}  // namespace axisgate::linmot::twin
