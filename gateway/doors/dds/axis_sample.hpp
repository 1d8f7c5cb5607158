// Which members of the topic AxisState show a value of the table of points. The IDL is fixed, so its members are listed here again; a
// member without a row, or a row that is not listed, does not compile. Members about the gateway and the site belong to the door.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <string_view>
#include <type_traits>
#include <utility>

#include "gateway/axis/points.hpp"
#include "gateway/doors/dds/bus.hpp"

namespace axisgate::dds {

template <class Sample>
struct SampleMember {
    std::string_view name;  ///< as in the IDL
    void (*put)(Sample&, const AxisPointRow&, const AxisPicture&);
};

/// A text member gets the value's word, a numeric one its number.
template <auto member, class Sample>
void put_point(Sample& sample, const AxisPointRow& row, const AxisPicture& p) {
    auto& into = sample.*member;
    using Into = std::remove_reference_t<decltype(into)>;
    const PointValue v = measured(row, p, 1);
    if constexpr (std::is_array_v<Into>) {
        const auto* text = std::get_if<std::string_view>(&v);
        put_text(into, row.word ? row.word(p) : text ? *text : std::string_view());
    } else {
        std::visit(
            [&into](const auto& x) {
                if constexpr (std::is_arithmetic_v<std::decay_t<decltype(x)>>) into = static_cast<Into>(x);
            },
            v);
    }
}
template <auto member, class Sample>
consteval SampleMember<Sample> sample_member(std::string_view name) {
    return {name, put_point<member, Sample>};
}

/// The rows of the members, in the order of the members.
template <const auto& rows, const auto& members>
consteval auto rows_of_members() {
    std::array<std::size_t, members.size()> places{};
    for (std::size_t m = 0; m < members.size(); ++m) {
        const auto it = std::ranges::find(rows, members[m].name, &AxisPointRow::sample);
        if (it == rows.end()) throw "a member of the sample stands in no row of the table";
        places[m] = static_cast<std::size_t>(it - rows.begin());
    }
    if (std::ranges::count_if(rows, [](const AxisPointRow& row) { return !row.sample.empty(); }) != std::ssize(members))
        throw "a row of the table names a member that the sample has not";
    return places;
}

template <const auto& rows, const auto& members, class Sample>
void put_points(Sample& sample, const AxisPicture& p) {
    static constexpr auto places = rows_of_members<rows, members>();
    for (std::size_t m = 0; m < members.size(); ++m)
        members[m].put(sample, rows[places[m]], p);
}

using AxisState = axisgate_AxisState;
inline constexpr std::array axis_state_members{
    sample_member<&AxisState::number, AxisState>("number"),
    sample_member<&AxisState::online, AxisState>("online"),
    sample_member<&AxisState::simulated, AxisState>("simulated"),
    sample_member<&AxisState::stale, AxisState>("stale"),
    sample_member<&AxisState::referenced, AxisState>("referenced"),
    sample_member<&AxisState::moving, AxisState>("moving"),
    sample_member<&AxisState::target_reached, AxisState>("target_reached"),
    sample_member<&AxisState::fault, AxisState>("fault"),
    sample_member<&AxisState::warning, AxisState>("warning"),
    sample_member<&AxisState::statusword, AxisState>("statusword"),
    sample_member<&AxisState::mode, AxisState>("mode"),
    sample_member<&AxisState::position, AxisState>("position"),
    sample_member<&AxisState::velocity, AxisState>("velocity"),
    sample_member<&AxisState::error_code, AxisState>("error_code"),
    sample_member<&AxisState::fail_safe_cause, AxisState>("fail_safe_cause"),
    sample_member<&AxisState::authority, AxisState>("authority"),
    sample_member<&AxisState::authority_holder, AxisState>("authority_holder"),
    sample_member<&AxisState::streaming, AxisState>("streaming"),
    sample_member<&AxisState::set_points, AxisState>("set_points"),
    sample_member<&AxisState::set_points_refused, AxisState>("set_points_refused"),
    sample_member<&AxisState::set_point_refusal, AxisState>("set_point_refusal"),
    sample_member<&AxisState::position_demand, AxisState>("position_demand"),
    sample_member<&AxisState::demand_source, AxisState>("demand_source"),
};

}  // namespace axisgate::dds
