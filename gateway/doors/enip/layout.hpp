// The EtherNet/IP device for the site in force: name, assemblies, parameters, as objects and EDS describe them. It contains no values.
// Parameters are numbered consecutively, axis after axis; at most 65535, further ones are not served.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "gateway/core/catalogue.hpp"
#include "gateway/protocols/cip/values.hpp"
#include "gateway/registers/profiles/language.hpp"
#include "gateway/site/assembly.hpp"
#include "gateway/site/site_state.hpp"

namespace axisgate::enip {

/// CONTRACT of the instances: 100+n and 150+n up to axis 40, 1000+n and 2000+n above; 100 and 150 all axes together.
inline constexpr std::uint32_t all_inputs = 100, all_outputs = 150, far_inputs = 1000, far_outputs = 2000, listen_heartbeat = 197,
                               input_heartbeat = 198, configuration = 199;
inline constexpr std::uint16_t last_near_axis = 40;
inline constexpr std::uint16_t bytes_per_axis = 32;

struct LayoutAxis {
    std::uint16_t number = 0;  ///< 1..1024
    AxisId id = no_axis;
    std::string name;
    const Catalogue* catalogue = nullptr;  ///< must outlive the layout; nullptr: no parameters
};
/// An assembly for a range of a unit's registers.
struct LayoutWindow {
    AssemblySpec spec;
    std::vector<AxisId> axes;
    std::string name;           ///< for messages
    std::uint16_t partner = 0;  ///< of an output
    std::string content;        ///< the content of its bytes, as text for comparison: mappings of the range, or the profile
};
[[nodiscard]] std::vector<LayoutWindow> windows_of(const SiteState& site);
/// Classes of another maker's device: an instance of them is a profile.
struct LayoutObjects {
    std::uint16_t instance = 1;
    std::uint8_t unit = 2;
    ProfileLanguage language{};
    AxisId axis = no_axis;
    std::shared_ptr<const registers::Language> page;
};
[[nodiscard]] std::vector<LayoutObjects> objects_of(const SiteState& site, const registers::Languages& pages);
struct HostFacts {
    std::string host_name;
    std::uint32_t address = 0, mask = 0, router = 0;  ///< in host byte order
    std::array<std::uint8_t, 6> mac{};
    std::uint32_t serial = 1;
    std::uint16_t port = 44818, io_port = 2222;
};

class Layout final : public cip::Description {
public:
    Layout() = default;
    Layout(std::vector<LayoutAxis> axes, std::uint32_t mapping_revision, const HostFacts& host, std::vector<LayoutWindow> windows = {},
           std::vector<LayoutObjects> objects = {});

    [[nodiscard]] const cip::Device& device() const override { return device_; }
    [[nodiscard]] std::optional<cip::AssemblyInfo> assembly(std::uint32_t instance) const override;
    [[nodiscard]] const std::vector<std::uint32_t>& assemblies() const override { return assemblies_; }
    [[nodiscard]] std::uint32_t parameters() const override { return parameters_; }
    [[nodiscard]] std::optional<cip::ParameterInfo> parameter(std::uint32_t instance) const override;

    struct ParameterPlace {
        const LayoutAxis* axis = nullptr;
        Point point;
    };
    [[nodiscard]] ParameterPlace place_of(std::uint32_t instance) const;
    /// The axes of an assembly, by number from `first` on; numbers without an axis are gaps.
    struct Range {
        std::uint16_t first = 0, count = 0;
    };
    [[nodiscard]] Range range_of(std::uint32_t instance) const;
    /// Calls `each(i, id)` for all axes of an assembly in the order of its bytes; no_axis: a gap.
    template <class Each>
    void each_axis(std::uint32_t instance, Each&& each) const {
        if (const auto* w = window(instance)) {
            for (std::uint16_t i = 0; i < w->axes.size(); ++i)
                each(i, w->axes[i]);
            return;
        }
        const Range r = range_of(instance);
        for (std::uint16_t i = 0; i < r.count; ++i) {
            const LayoutAxis* const a = axis(static_cast<std::uint16_t>(r.first + i));
            each(i, a ? a->id : no_axis);
        }
    }
    /// The same without gaps.
    [[nodiscard]] std::vector<AxisId> axes_of(std::uint32_t instance) const {
        std::vector<AxisId> list;
        each_axis(instance, [&](std::uint16_t, AxisId id) {
            if (id != no_axis) list.push_back(id);
        });
        return list;
    }
    /// nullptr: no axis has this number.
    [[nodiscard]] const LayoutAxis* axis(std::uint16_t number) const;
    [[nodiscard]] const std::vector<LayoutAxis>& axes() const noexcept { return axes_; }
    /// nullptr: this assembly is not one of the site's own.
    [[nodiscard]] const LayoutWindow* window(std::uint32_t instance) const;
    [[nodiscard]] const std::vector<LayoutObjects>& objects() const noexcept { return objects_; }
    struct ObjectRow {
        const LayoutObjects* object = nullptr;
        const registers::LanguageRow* row = nullptr;
    };
    /// Attribute 0: whether the instance exists, with any row of the class.
    [[nodiscard]] ObjectRow object_row(std::uint32_t class_id, std::uint32_t instance, std::uint32_t attribute) const;
    [[nodiscard]] std::uint32_t mapping_revision() const noexcept { return mapping_revision_; }
    /// True if this assembly has the same bytes there: size, meaning and axis of each.
    [[nodiscard]] bool same_bytes(std::uint32_t instance, const Layout& there) const;
    /// For messages: "axis feeder to the originator".
    [[nodiscard]] std::string name_of(std::uint32_t instance) const;

private:
    std::vector<LayoutAxis> axes_;       // by number
    std::vector<LayoutWindow> windows_;  // by instance
    std::vector<LayoutObjects> objects_;
    std::uint32_t mapping_revision_ = 0;
    cip::Device device_;
    std::vector<std::uint32_t> assemblies_;
    std::map<const Catalogue*, std::vector<Point>> points_;
    std::vector<std::uint32_t> first_parameter_;  // of each of axes_
    std::uint32_t parameters_ = 0;
};

/// The electronic data sheet of a layout.
[[nodiscard]] std::string eds_of(const Layout& layout);

/// A value in CIP's form, and back. Empty if it does not fit its type.
[[nodiscard]] std::optional<cip::Bytes> to_bytes(const Value& value, cip::DataType type);
[[nodiscard]] std::optional<Value> from_bytes(cip::View bytes, cip::DataType type);

}  // namespace axisgate::enip
