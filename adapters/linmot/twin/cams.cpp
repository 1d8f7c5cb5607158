#include "adapters/linmot/twin/cams.hpp"

#include <algorithm>
#include <cmath>

namespace axisgate::linmot::twin {
namespace {
std::uint32_t read32(const std::vector<std::uint8_t>& b, std::size_t at) {
    std::uint32_t v = 0;
    for (std::size_t i = 0; i < 4 && at + i < b.size(); ++i)
        v |= std::uint32_t{b[at + i]} << 8 * i;
    return v;
}
}  // namespace

double Curve::point(std::size_t i) const noexcept { return static_cast<std::int32_t>(read32(data, i * 4)); }
double Curve::x_length() const noexcept { return read32(info, 32); }
Followed Curve::at(double part) const noexcept {
    const double n = static_cast<double>(points() - 1);
    const double x = std::clamp(part, 0.0, 1.0) * n;
    const auto i = std::min(static_cast<std::size_t>(x), points() - 2);
    const double a = point(i), b = point(i + 1);
    return {a + (b - a) * (x - static_cast<double>(i)), (b - a) * n};
}

Followed Cam::at(double count, const Curve& of) const noexcept {
    const Followed f = of.at((count - start) / length);
    const bool inside = count >= start && count < end();
    return {offset + scale * f.position, inside ? scale * f.slope / length : 0};
}

CamRange CamRange::of(std::span<const Cam> cams, bool modulo) noexcept {
    CamRange r;
    double last = 0;
    bool any = false;
    for (const Cam& c : cams) {
        if (!c.used()) continue;
        r.first = any ? std::min(r.first, c.start) : c.start;
        last = any ? std::max(last, c.end()) : c.end();
        any = true;
    }
    r.length = any ? last - r.first : 0;
    r.modulo = modulo;
    return r;
}
double CamRange::wrapped(double count) const noexcept {
    if (!modulo || length <= 0) return count;
    const double n = std::floor((count - first) / length);
    return count - n * length;
}
bool CamRange::passes(double from, double to, double place) const noexcept {
    const bool upwards = to > from;
    const auto at = meets(from, place, upwards);
    return from != to && at && (upwards ? *at <= to : *at >= to);
}
std::optional<double> CamRange::meets(double from, double place, bool upwards) const noexcept {
    double at = place;
    if (modulo && length > 0) {
        const double n = (from - place) / length;
        at = place + (upwards ? std::floor(n) + 1 : std::ceil(n) - 1) * length;
    }
    if (upwards ? at > from : at < from) return at;
    return std::nullopt;
}

const Cam* cam_at(std::span<const Cam> cams, const CamRange& range, double count) noexcept {
    const double c = range.wrapped(count);
    const Cam *governs = nullptr, *first = nullptr;
    for (const Cam& cam : cams) {
        if (!cam.used()) continue;
        if (!first || cam.start < first->start) first = &cam;
        if (cam.start <= c && (!governs || cam.start > governs->start)) governs = &cam;
    }
    return governs ? governs : first;
}

double Winding::strokes(double turned, double counts_per_revolution) const noexcept {
    const double whole = std::max(1.0, revolutions * counts_per_revolution);
    const double r0 = std::max(1.0, start_ratio), r1 = std::max(1.0, end_ratio);
    const double until = std::min(turned, whole);
    // The ratio changes linearly over the revolutions: the number of strokes is the integral of its reciprocal.
    const double part = std::fabs(r1 - r0) < 1e-9 ? until / r0 : whole / (r1 - r0) * std::log1p((r1 - r0) / r0 * until / whole);
    return part + std::max(0.0, turned - whole) / r1;
}

double Winding::at(double turned, double adapted, double counts_per_revolution, const Curve* shape) const noexcept {
    const double s = strokes(std::fabs(turned), counts_per_revolution);
    const double whole = std::floor(s);
    double part = s - whole;
    if (shape && shape->points() > 1 && shape->last() != shape->first())
        part = (shape->at(part).position - shape->first()) / (shape->last() - shape->first());
    const double progress = std::clamp(std::fabs(adapted) / std::max(1.0, revolutions * counts_per_revolution), 0.0, 1.0);
    double l = left + (end_left - left) * progress, r = right + (end_right - right) * progress;
    if (disturbance_length > 0) {
        const double along = std::fmod(strokes(std::fabs(adapted), counts_per_revolution) / disturbance_length, 1.0);
        const double shift = disturbance_stroke * (1 - std::fabs(2 * along - 1));
        l += shift;
        r += antiparallel ? -shift : shift;
    }
    return std::fmod(whole, 2.0) == 0 ? l + (r - l) * part : r + (l - r) * part;
}

}  // namespace axisgate::linmot::twin
