// One of the site's own assemblies: a range of a unit's registers as bytes, value by value; and the way of an output into the register map.
// Set-points go to the lanes of their axes, other values are written by the register writer. Only changes are written, and nothing of the
// first image, which is a base. A refused value affects only itself. Bounds: one outstanding write per parameter, then the newest value
// waits; the writer's tickets bound the rest (then busy).
#pragma once

#include <map>
#include <string>
#include <vector>

#include "gateway/core/counter.hpp"
#include "gateway/doors/enip/output_lane.hpp"
#include "gateway/engine/door.hpp"
#include "gateway/registers/register_image.hpp"
#include "gateway/registers/writer.hpp"
#include "gateway/site/assembly.hpp"

namespace axisgate::enip {

/// Converts registers in Modbus form (big-endian, words in each value's order) to the assembly's bytes, and back. Both have 2 * registers
/// bytes; bytes without a value are 0.
void to_assembly(const AssemblySpec& a, const std::vector<registers::MapValue>& values, const std::uint8_t* from, std::uint8_t* to);
void from_assembly(const AssemblySpec& a, const std::vector<registers::MapValue>& values, const std::uint8_t* from, std::uint8_t* to);

/// The values that a read of the assembly shows, also of an output: those that can be read. The list changes with the site.
[[nodiscard]] std::vector<registers::MapValue> shown_values(registers::RegisterImage& image, const AssemblySpec& a);
/// Appends the assembly's bytes; zeros where nothing is mapped. `values` is shown_values(). Allocates nothing if `to` has the capacity.
void show_window(registers::RegisterImage& image, const AssemblySpec& a, const std::vector<registers::MapValue>& values, Instant now,
                 cip::Bytes& to);
/// Changes with each change of the shown values, except ages and heartbeats.
[[nodiscard]] std::uint64_t window_revision(registers::RegisterImage& image, const AssemblySpec& a,
                                            const std::vector<registers::MapValue>& values, Instant now);
/// A write of the whole assembly at once, by a message.
struct WindowWritten {
    Reason why = Reason::none;      ///< none: every value was passed on; otherwise none was, except those that a language has accepted
    std::uint16_t outstanding = 0;  ///< number of calls of the owner's on_written that follow
};
[[nodiscard]] WindowWritten write_window(registers::RegisterImage& image, registers::RegisterWriter& writer, const AssemblySpec& a,
                                         registers::WriteOwner& owner, const Origin& origin, cip::View data, Instant now);

class WindowOutput final : public registers::WriteOwner {
public:
    WindowOutput(DoorPort& port, registers::RegisterImage& image, registers::RegisterWriter& writer, Counter& commands, AssemblySpec spec,
                 Origin origin);
    ~WindowOutput() override;
    WindowOutput(const WindowOutput&) = delete;
    WindowOutput& operator=(const WindowOutput&) = delete;

    /// The axes with set-points in it, and their members.
    [[nodiscard]] const std::map<AxisId, std::uint8_t>& members() const noexcept { return members_; }
    /// Starts again as if nothing had been sent.
    void reset();
    /// A new image of the assembly's length. `wanted` has the newest set-points afterwards.
    void take(cip::View data, Instant now);
    [[nodiscard]] const Wanted& wanted(AxisId axis) { return wanted_[axis]; }

    void on_written(std::uint8_t slot, AxisId axis, registers::Verdict verdict) override;

private:
    static constexpr std::uint8_t whole = 0xFF;  // slot of a write that waits for nothing
    void take_image(registers::UnitMap& map, bool first, Instant now);
    void take_values(registers::UnitMap& map, bool first, Instant now);
    void write_one(registers::UnitMap& map, std::size_t i, Instant now);
    [[nodiscard]] bool differs(std::size_t i) const;
    [[nodiscard]] registers::RequestNote note_of(const registers::MapValue& v) const;
    void tell_refusals(const registers::MapValue& of, Instant now);

    DoorPort& port_;
    registers::RegisterImage& image_;
    registers::RegisterWriter& writer_;
    Counter& commands_;
    AssemblySpec spec_;
    registers::RegisterWriter::Client client_;
    std::vector<registers::MapValue> values_;
    std::map<AxisId, std::uint8_t> members_;
    std::map<AxisId, Wanted> wanted_;
    std::vector<std::uint8_t> newest_, before_;  // as registers
    struct Write {
        bool on_its_way = false, due = false;
    };
    std::vector<Write> writes_;  // of values_
    bool any_ = false;
    const registers::UnitMap* seen_ = nullptr;  // the map of the last image
    registers::WritePlan plan_;                 // kept, so that no memory is allocated for it
    std::vector<registers::MapValue> changed_;  // kept as well
    std::vector<registers::Refused> refused_;   // kept as well
};

}  // namespace axisgate::enip
