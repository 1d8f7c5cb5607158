// Window: an assembly of the site's own: a range of a unit's registers as bytes, value by value; and an output's way into the register map.
// In: the assembly, images as an originator renews them. Out: bytes; set-points per axis for the lanes; writes of what is no set-point, by
// the register writer. Never writes what has not changed, and nothing of the first image: it is a base. A value that is refused spoils
// itself alone. Bounds: of each parameter one write is on its way, then the newest value waits; the writer's tickets bound the rest (then
// busy).
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

/// Registers as Modbus has them (big-endian, words in each value's order) into the assembly's bytes, and back. Both have 2 * registers
/// bytes; what belongs to no value is 0.
void to_assembly(const AssemblySpec& a, const std::vector<registers::MapValue>& values, const std::uint8_t* from, std::uint8_t* to);
void from_assembly(const AssemblySpec& a, const std::vector<registers::MapValue>& values, const std::uint8_t* from, std::uint8_t* to);

/// The values that a read of the assembly shows: of an output, too, those that can be read. Another list after a change of the site.
[[nodiscard]] std::vector<registers::MapValue> shown_values(registers::RegisterImage& image, const AssemblySpec& a);
/// Appends the assembly's bytes; zeros where nothing is behind it. `values`: shown_values(). Allocates nothing where `to` has the room.
void show_window(registers::RegisterImage& image, const AssemblySpec& a, const std::vector<registers::MapValue>& values, Instant now,
                 cip::Bytes& to);
/// Another number after each change of what it shows, but for ages and heartbeats.
[[nodiscard]] std::uint64_t window_revision(registers::RegisterImage& image, const AssemblySpec& a,
                                            const std::vector<registers::MapValue>& values, Instant now);
/// A write of the whole at once, that of a message.
struct WindowWritten {
    Reason why = Reason::none;      ///< none: every value of it was handed on; else nothing was, but what a language has taken
    std::uint16_t outstanding = 0;  ///< so many calls of the owner's on_written follow
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

    /// Axes whose set-points are in it, with the members that are.
    [[nodiscard]] const std::map<AxisId, std::uint8_t>& members() const noexcept { return members_; }
    /// From here on as if nothing had been sent.
    void reset();
    /// A new image, as long as the assembly. Then `wanted` has the newest set-points.
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
    const registers::UnitMap* seen_ = nullptr;  // whose image it was
    registers::WritePlan plan_;                 // kept, so that nothing is allocated for it
    std::vector<registers::MapValue> changed_;  // as well
    std::vector<registers::Refused> refused_;   // as well
};

}  // namespace axisgate::enip
