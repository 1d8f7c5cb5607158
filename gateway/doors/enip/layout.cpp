// Instances by axis number, parameters by axis and catalogue; axes of one catalogue share its list. The order in which axes were added has
// no effect.
#include "gateway/doors/enip/layout.hpp"

#include <algorithm>
#include <bit>
#include <boost/json/serialize.hpp>
#include <cmath>

#include "gateway/protocols/cip/eds.hpp"

namespace axisgate::enip {
namespace {
using cip::AssemblyInfo;
using cip::Bytes;
using cip::DataType;

DataType data_type_of(ValueType type) noexcept {
    switch (type) {
        case ValueType::boolean:
            return DataType::boolean;
        case ValueType::u8:
            return DataType::usint;
        case ValueType::i8:
            return DataType::sint;
        case ValueType::u16:
            return DataType::uint16;
        case ValueType::i16:
            return DataType::int16;
        case ValueType::u32:
            return DataType::udint;
        case ValueType::i24:
        case ValueType::i32:
            return DataType::dint;
        case ValueType::i64:
            return DataType::lint;
        case ValueType::f32:
            return DataType::real;
        case ValueType::f64:
            return DataType::lreal;
        case ValueType::text:
        case ValueType::bytes:
            break;
    }
    return DataType::short_string;
}

constexpr std::uint8_t device_major = 1, device_minor = 1;

struct Span {
    double low, high;
};
Span span_of(DataType type) noexcept {
    switch (type) {
        case DataType::boolean:
            return {0, 1};
        case DataType::sint:
            return {-128, 127};
        case DataType::usint:
            return {0, 255};
        case DataType::int16:
            return {-32768, 32767};
        case DataType::uint16:
            return {0, 65535};
        case DataType::dint:
            return {-2147483648.0, 2147483647.0};
        case DataType::udint:
            return {0, 4294967295.0};
        case DataType::lint:
            return {-9.2e18, 9.2e18};
        case DataType::real:
            return {-3.4e38, 3.4e38};
        default:
            return {-1.7e308, 1.7e308};
    }
}

/// A bound that the type cannot represent is replaced by the type's nearest end.
Bytes bound(const std::optional<double>& value, double otherwise, DataType type) {
    if (type == DataType::short_string) return {};
    const Span s = span_of(type);
    const double v = std::clamp(value.value_or(otherwise), s.low, s.high);
    return to_bytes(Value{v}, type).value_or(Bytes(cip::size_of(type)));
}
double nearest_to_zero(const Parameter& p, const Span& s) { return std::max(p.min.value_or(s.low), std::min(0.0, p.max.value_or(s.high))); }
bool is_whole(DataType type) noexcept { return type != DataType::real && type != DataType::lreal && type != DataType::short_string; }
}  // namespace

std::optional<Bytes> to_bytes(const Value& value, DataType type) {
    Bytes out;
    if (type == DataType::short_string) {
        cip::put_short_string(out, to_text(value));
        return out;
    }
    const auto number = as_number(value);
    if (!number) return std::nullopt;
    if (type == DataType::real) {
        cip::put32(out, std::bit_cast<std::uint32_t>(static_cast<float>(*number)));
        return out;
    }
    if (type == DataType::lreal) {
        cip::put(out, std::bit_cast<std::uint64_t>(*number), 8);
        return out;
    }
    const auto whole = known(value) && std::holds_alternative<double>(value)
                           ? std::optional(static_cast<std::int64_t>(std::llround(*number)))
                           : as_integer(value);
    const Span s = span_of(type);
    if (!whole || static_cast<double>(*whole) < s.low || static_cast<double>(*whole) > s.high) return std::nullopt;
    cip::put(out, static_cast<std::uint64_t>(*whole), cip::size_of(type));
    return out;
}

std::optional<Value> from_bytes(cip::View bytes, DataType type) {
    if (type == DataType::short_string) {
        if (bytes.empty() || bytes.size() != 1u + bytes[0]) return std::nullopt;
        return Value{std::string(bytes.begin() + 1, bytes.end())};
    }
    if (bytes.size() != cip::size_of(type)) return std::nullopt;
    std::uint64_t raw = 0;
    for (std::size_t i = bytes.size(); i-- > 0;)
        raw = raw << 8 | bytes[i];
    if (type == DataType::real) {
        const float f = std::bit_cast<float>(static_cast<std::uint32_t>(raw));
        return std::isfinite(f) ? std::optional(Value{static_cast<double>(f)}) : std::nullopt;
    }
    if (type == DataType::lreal) {
        const double d = std::bit_cast<double>(raw);
        return std::isfinite(d) ? std::optional(Value{d}) : std::nullopt;
    }
    if (type == DataType::boolean) return raw <= 1 ? std::optional(Value{raw != 0}) : std::nullopt;
    const bool is_signed = span_of(type).low < 0;
    const unsigned shift = 64 - 8 * static_cast<unsigned>(bytes.size());
    const auto value = is_signed ? static_cast<std::int64_t>(raw << shift) >> shift : static_cast<std::int64_t>(raw);
    return Value{value};
}

namespace {
/// One for each element of each parameter.
std::vector<Point> points_of(const Catalogue& catalogue) {
    std::vector<Point> list;
    const auto parameters = catalogue.parameters();
    for (std::size_t i = 0; i < parameters.size(); ++i) {
        const Parameter& p = parameters[i];
        const std::uint32_t elements = p.count == 0 ? 1 : p.count;
        for (std::uint32_t e = 0; e < elements; ++e)
            list.push_back({static_cast<std::uint16_t>(i), static_cast<std::uint16_t>(p.count == 0 ? 0 : p.first + e)});
    }
    return list;
}

cip::ParameterInfo info_of(const Parameter& p, std::uint16_t element) {
    cip::ParameterInfo info;
    info.name = p.count == 0 ? p.name : p.name + "[" + std::to_string(element) + "]";
    info.type = data_type_of(p.type);
    info.units = p.unit;
    info.help = p.description;
    info.readable = p.readable();
    info.writable = p.writable() && p.type != ValueType::bytes;
    const Span s = span_of(info.type);
    info.min = bound(p.min, s.low, info.type);
    info.max = bound(p.max, s.high, info.type);
    if (info.type != DataType::short_string)
        info.fallback = to_bytes(p.factory_default, info.type).value_or(bound(nearest_to_zero(p, s), 0, info.type));
    if (is_whole(info.type)) {
        for (const auto& [number, meaning] : p.allowed)
            info.allowed.emplace_back(number, meaning);
    }
    return info;
}

/// The entries that touch a range of a unit's registers, as in the site's document, without members for people.
std::string content_of(const Site& site, const AssemblySpec& a) {
    std::string text;
    const auto add = [&](boost::json::object entry) {
        entry.erase("comment");
        entry.erase("id");
        text += boost::json::serialize(entry) + "\n";
    };
    add(to_json(a));
    for (const ProfileSpec& p : site.profiles) {
        if (p.unit == a.unit) add(to_json(p));
    }
    for (const Mapping& m : site.map()) {
        if (m.unit == a.unit && m.table == a.table && m.address < a.address + a.registers && m.end() > a.address) add(to_json(m));
    }
    return text;
}
}  // namespace

std::vector<LayoutWindow> windows_of(const SiteState& state) {
    std::vector<LayoutWindow> list;
    for (auto& a : assemblies_of(state.site)) {
        LayoutWindow w{a.spec, {}, std::move(a.name), a.partner, content_of(state.site, a.spec)};
        for (const auto& name : a.axes) {
            const auto it = std::ranges::find(state.site.axes, name, &AxisSpec::name);
            const auto i = static_cast<std::size_t>(it - state.site.axes.begin());
            if (i < state.axis_ids.size()) w.axes.push_back(state.axis_ids[i]);
        }
        list.push_back(std::move(w));
    }
    return list;
}

std::vector<LayoutObjects> objects_of(const SiteState& state, const registers::Languages& pages) {
    std::vector<LayoutObjects> list;
    for (const auto& p : state.site.profiles) {
        const auto& page = pages[static_cast<std::size_t>(p.language)];
        if (!p.object_instance || !page || p.axes.empty()) continue;
        const auto it = std::ranges::find(state.site.axes, p.axes.front().axis, &AxisSpec::name);
        const auto i = static_cast<std::size_t>(it - state.site.axes.begin());
        if (i < state.axis_ids.size()) list.push_back({*p.object_instance, p.unit, p.language, state.axis_ids[i], page});
    }
    return list;
}

Layout::Layout(std::vector<LayoutAxis> axes, std::uint32_t mapping_revision, const HostFacts& host, std::vector<LayoutWindow> windows,
               std::vector<LayoutObjects> objects)
    : axes_(std::move(axes)), windows_(std::move(windows)), objects_(std::move(objects)), mapping_revision_(mapping_revision) {
    std::ranges::sort(windows_, {}, [](const LayoutWindow& w) { return w.spec.instance; });
    std::erase_if(axes_, [](const LayoutAxis& a) { return a.number == 0; });
    std::ranges::sort(axes_, {}, &LayoutAxis::number);
    device_.vendor = 0xFFFF;  // no number of an organization is claimed
    device_.device_type = 0x0C;
    device_.product_code = 1;
    // The device's own revision for every site, because an originator's electronic key asks which device it is. Whether its program fits is
    // checked when a connection is opened, by the assemblies that it names and their sizes.
    device_.major = device_major;
    device_.minor = device_minor;
    device_.consistency = static_cast<std::uint16_t>(mapping_revision ^ mapping_revision >> 16);
    device_.serial = host.serial;
    device_.name = "axisgate";
    device_.host_name = host.host_name;
    device_.address = host.address;
    device_.mask = host.mask;
    device_.router = host.router;
    device_.mac = host.mac;
    device_.port = host.port;
    device_.io_port = host.io_port;

    assemblies_ = {all_inputs, all_outputs, listen_heartbeat, input_heartbeat, configuration};
    for (const LayoutAxis& a : axes_) {
        const bool near = a.number <= last_near_axis;
        assemblies_.push_back((near ? all_inputs : far_inputs) + a.number);
        assemblies_.push_back((near ? all_outputs : far_outputs) + a.number);
        first_parameter_.push_back(parameters_ + 1);
        if (!a.catalogue) continue;
        auto& list = points_[a.catalogue];
        if (list.empty()) list = points_of(*a.catalogue);
        parameters_ = static_cast<std::uint32_t>(std::min<std::size_t>(parameters_ + list.size(), 0xFFFF));
    }
    for (const LayoutWindow& w : windows_)
        assemblies_.push_back(w.spec.instance);
    std::ranges::sort(assemblies_);
}

const LayoutAxis* Layout::axis(std::uint16_t number) const {
    const auto it = std::ranges::lower_bound(axes_, number, {}, &LayoutAxis::number);
    return it != axes_.end() && it->number == number ? &*it : nullptr;
}

const LayoutWindow* Layout::window(std::uint32_t instance) const {
    const auto it = std::ranges::lower_bound(windows_, instance, {}, [](const LayoutWindow& w) { return std::uint32_t{w.spec.instance}; });
    return it != windows_.end() && it->spec.instance == instance ? &*it : nullptr;
}

Layout::ObjectRow Layout::object_row(std::uint32_t class_id, std::uint32_t instance, std::uint32_t attribute) const {
    const auto it = std::ranges::find(objects_, instance, [](const LayoutObjects& o) { return std::uint32_t{o.instance}; });
    if (it == objects_.end()) return {};
    const auto row = std::ranges::find_if(it->page->rows, [&](const registers::LanguageRow& r) {
        return r.holding && r.object && r.object->class_id == class_id && (attribute == 0 || r.object->attribute == attribute);
    });
    return row == it->page->rows.end() ? ObjectRow{} : ObjectRow{&*it, &*row};
}

bool Layout::same_bytes(std::uint32_t instance, const Layout& there) const {
    const auto here_info = assembly(instance), there_info = there.assembly(instance);
    if (!here_info || !there_info) return here_info.has_value() == there_info.has_value();
    if (here_info->role != there_info->role || here_info->size != there_info->size) return false;
    const LayoutWindow *const w = window(instance), *const x = there.window(instance);
    if (w || x) return w && x && w->axes == x->axes && w->content == x->content;
    // An axis that was made anew is another one, although it looks the same.
    const Range r = range_of(instance), s = there.range_of(instance);
    if (r.first != s.first || r.count != s.count) return false;
    for (std::uint16_t i = 0; i < r.count; ++i) {
        const auto number = static_cast<std::uint16_t>(r.first + i);
        const LayoutAxis *const a = axis(number), *const b = there.axis(number);
        if ((a ? a->id : no_axis) != (b ? b->id : no_axis)) return false;
    }
    return true;
}

Layout::Range Layout::range_of(std::uint32_t instance) const {
    if (instance == all_inputs || instance == all_outputs) return {1, axes_.empty() ? std::uint16_t{0} : axes_.back().number};
    std::uint32_t number = 0;
    if (instance > all_inputs && instance <= all_inputs + last_near_axis) number = instance - all_inputs;
    if (instance > all_outputs && instance <= all_outputs + last_near_axis) number = instance - all_outputs;
    if (instance > far_inputs + last_near_axis && instance <= far_inputs + max_axes) number = instance - far_inputs;
    if (instance > far_outputs + last_near_axis && instance <= far_outputs + max_axes) number = instance - far_outputs;
    return number != 0 && axis(static_cast<std::uint16_t>(number)) ? Range{static_cast<std::uint16_t>(number), 1} : Range{};
}

std::optional<cip::AssemblyInfo> Layout::assembly(std::uint32_t instance) const {
    using Role = AssemblyInfo::Role;
    switch (instance) {
        case listen_heartbeat:
            return AssemblyInfo{Role::listen_only, 0};
        case input_heartbeat:
            return AssemblyInfo{Role::input_only, 0};
        case configuration:
            return AssemblyInfo{Role::configuration, 0};
        default:
            break;
    }
    if (const auto* w = window(instance))
        return AssemblyInfo{w->spec.direction == AssemblyDirection::output ? Role::output : Role::input, w->spec.bytes(), w->partner};
    const Range r = range_of(instance);
    if (r.count == 0 && instance != all_inputs && instance != all_outputs) return std::nullopt;
    const bool output = (instance >= all_outputs && instance <= all_outputs + last_near_axis) || instance > far_outputs + last_near_axis;
    const std::uint32_t partner = !output                  ? 0
                                  : instance > far_outputs ? instance - far_outputs + far_inputs
                                                           : instance - all_outputs + all_inputs;
    return AssemblyInfo{output ? Role::output : Role::input, static_cast<std::uint16_t>(r.count * bytes_per_axis), partner};
}

std::string Layout::name_of(std::uint32_t instance) const {
    const auto info = assembly(instance);
    if (!info) return {};
    using Role = AssemblyInfo::Role;
    if (info->role == Role::configuration) return "configuration (empty)";
    if (info->role == Role::input_only) return "heartbeat, input only";
    if (info->role == Role::listen_only) return "heartbeat, listen only";
    if (const auto* w = window(instance)) return w->name;
    const bool one = instance != all_inputs && instance != all_outputs;
    const std::string what = one ? "axis " + axis(range_of(instance).first)->name : std::string("all axes");
    return what + (info->role == Role::input ? " to the originator" : " from the originator");
}

Layout::ParameterPlace Layout::place_of(std::uint32_t instance) const {
    if (instance == 0 || instance > parameters_) return {};
    const auto it = std::ranges::upper_bound(first_parameter_, instance) - 1;
    const LayoutAxis& a = axes_[static_cast<std::size_t>(it - first_parameter_.begin())];
    return {&a, points_.at(a.catalogue).at(instance - *it)};
}

std::optional<cip::ParameterInfo> Layout::parameter(std::uint32_t instance) const {
    const ParameterPlace place = place_of(instance);
    if (!place.axis) return std::nullopt;
    return info_of(place.axis->catalogue->parameters()[place.point.parameter], place.point.element);
}

std::string eds_of(const Layout& layout) {
    return cip::eds_text(layout, {"axisgate", "Communications Adapter", "axisgate", [&](std::uint32_t i) { return layout.name_of(i); },
                                  [&](std::uint32_t i) { return layout.place_of(i).axis->name + " " + layout.parameter(i)->name; }});
}

}  // namespace axisgate::enip
