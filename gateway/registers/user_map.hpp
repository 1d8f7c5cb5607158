// User map: the registers and bits of one unit id 2..254 as the site's mappings have them.
// In: checked mappings with their axes; requests; results of its readings. Out: register bytes, bits, the commands of a write.
// Parameters are read from the drive when a client asks for them: what is answered is the last value known, at most one reading old, and a
// new reading is asked for. Never holds up a request for a drive, and never shows a parameter of an axis that does not answer.
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

/// A mapping whose axis has been found in the running site.
struct PlacedMapping {
    Mapping mapping;
    AxisId axis = no_axis;
    double increments_per_unit = 1;
};

/// What a register shows of an axis, before scale and offset. What no picture says is told here: the age, the heartbeat, the mapping.
[[nodiscard]] Value axis_value(const AxisPointRow& row, const Image& image, const AxisPicture& picture, double increments_per_unit,
                               Instant now);

class UserMap final : public UnitMap {
public:
    /// Gives a command of the map's own to the gateway; false: too many wait. Its result comes to on_own_result.
    using Ask = std::function<bool(UnitMap&, PlannedCommand)>;
    /// A parameter is asked for again when a client wants it and the value is this old.
    static constexpr Duration fresh_for = std::chrono::milliseconds(250);
    /// Readings on their way at once, per unit.
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
    /// A value that a drive reported, whoever had asked: a write of another door is seen here at once.
    void on_sample(const Sample& sample);
    /// Asks for every parameter that has not been read yet, so that the first client finds values.
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
    /// First entry that ends behind `address`.
    [[nodiscard]] Places::const_iterator first_at(const Places& list, std::uint32_t address) const noexcept;
    /// Calls `f` for each entry of the range in order; illegal_address if an address of it belongs to none.
    template <class F>
    [[nodiscard]] Verdict each_written(Table table, std::uint16_t address, std::uint16_t count, F&& f);
    /// The same for a read. What can only be written is as if it were not there. With MapGaps::zero addresses without an entry are passed
    /// over, as long as the range touches one that has: a client that reads in blocks asks for at least one value in each of them, and one
    /// that asks for none has the wrong table or counts its addresses from 1.
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
