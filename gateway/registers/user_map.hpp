// The registers and bits of one unit id 2..254, as the site's mappings define them. Parameters are read from the drive when a client
// requests them: the answer is the last known value, at most one read old, and a new read is started. A request never waits for a drive,
// and a parameter of an axis that does not answer is not shown.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <utility>
#include <vector>

#include "gateway/axis/points.hpp"
#include "gateway/engine/door.hpp"
#include "gateway/registers/unit_map.hpp"
#include "gateway/site/mapping.hpp"

namespace axisgate::registers {

/// A mapping whose axis was found in the site in force.
struct PlacedMapping {
    Mapping mapping;
    AxisId axis = no_axis;
    double increments_per_unit = 1;
};

/// The value of an axis in a register, before scale and offset. Values that are not in the picture are arguments: age, heartbeat, mapping.
[[nodiscard]] Value axis_value(const AxisPointRow& row, const Image& image, const AxisPicture& picture, double increments_per_unit,
                               Instant now);

class UserMap final : public UnitMap {
public:
    /// Gives a command of the map to the gateway; false if too many are waiting. Its result goes to on_own_result.
    using Ask = std::function<bool(UnitMap&, PlannedCommand)>;
    /// A parameter is read again when a client requests it and the value is this old.
    static constexpr Duration fresh_for = std::chrono::milliseconds(250);
    /// Limit of outstanding reads per unit.
    static constexpr std::size_t most_readings = 16;

    UserMap(const DoorPort& port, std::vector<PlacedMapping> mappings, MapGaps gaps, Ask ask);

    Verdict check_read(Table table, std::uint16_t address, std::uint16_t count) override;
    Verdict read_registers(Table table, std::uint16_t address, std::uint16_t count, Instant now, std::uint8_t* out) override;
    Verdict read_bits(Table table, std::uint16_t address, std::uint16_t count, std::uint8_t* out) override;
    bool is_exact(std::uint16_t address, Instant now) override;
    Verdict check_write(Table table, std::uint16_t address, std::uint16_t count) override;
    Verdict write(Table table, std::uint16_t address, std::uint16_t count, const std::uint8_t* data, WritePlan& plan) override;
    void on_own_result(std::uint32_t note, const Result& result) override;
    std::vector<MapValue> values(Table table, std::uint16_t address, std::uint16_t count, bool written) override;
    void show(Table table, std::uint16_t address, std::uint16_t count, Instant now, std::uint8_t* out) override;
    /// Stores a value that a drive reported for any reason, so that a write of another door is visible at once.
    void on_sample(const Sample& sample);
    /// Reads every parameter that has not been read yet, so that the first client finds values.
    void begin(Instant now);

private:
    struct Place {
        PlacedMapping at;
        const AxisPointRow* row = nullptr;  ///< of the axis; null: a parameter
        std::uint32_t value = 0;            ///< index in values_, for parameters
    };
    struct ParameterValue {
        AxisId axis = no_axis;
        Point point;
        Value value;
        Instant at{};
        bool asked = false;
    };
    using Places = std::vector<Place>;

    [[nodiscard]] const Places& places(Table table) const noexcept { return tables_[static_cast<std::size_t>(table)]; }
    /// The first entry that ends behind `address`.
    [[nodiscard]] Places::const_iterator first_at(const Places& list, std::uint32_t address) const noexcept;
    /// Calls `f` for each entry of the range in order; illegal_address if an address of it belongs to none.
    template <class F>
    [[nodiscard]] Verdict each_written(Table table, std::uint16_t address, std::uint16_t count, F&& f);
    /// The same for a read; write-only entries are left out. With MapGaps::zero, addresses without an entry are skipped if the range
    /// includes at least one entry: a client that reads in blocks reads at least one value in each, and a range without any entry is in the
    /// wrong table or is counted from 1.
    template <class F>
    [[nodiscard]] Verdict each_read(Table table, std::uint16_t address, std::uint16_t count, F&& f);
    [[nodiscard]] Verdict refuse_gap(Table table, std::uint32_t address, bool nothing_at_all);
    [[nodiscard]] Verdict refuse_axis(const Place& place);
    [[nodiscard]] Verdict value_of(const Place& place, Instant now, Value& value);
    [[nodiscard]] Verdict plan_value(const Place& place, const Value& value, WritePlan& plan);
    void want(std::uint32_t index, Instant now);

    const DoorPort& port_;
    MapGaps gaps_;
    Ask ask_;
    std::array<Places, 4> tables_;
    std::vector<ParameterValue> values_;
    std::map<std::pair<AxisId, Point>, std::uint32_t> index_;  ///< of values_
    std::size_t readings_ = 0;
};

}  // namespace axisgate::registers
