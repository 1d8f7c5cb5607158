// A unit that uses another device's language. This class contains the parts that all languages share: existing registers, halves of 32-bit
// values, ranges, conversion between counts of the language and increments, refusals. Each language gives its registers their meaning. A
// command of a language is always a part of a client's write.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "gateway/engine/door.hpp"
#include "gateway/registers/profiles/language.hpp"
#include "gateway/registers/unit_map.hpp"

namespace axisgate::registers {

struct PlacedProfileAxis {
    AxisId id = no_axis;
    int number = 0;  ///< in the register map
    std::string name;
    double increments_per_count = 1;  ///< > 0
    double counts_per_unit = 1;
    /// Of the site's entry, or the axis' own limits: counts/s and counts/s^2.
    std::optional<double> velocity, acceleration;
    std::optional<double> lowest, highest;  ///< limits of the position, counts
    bool operator==(const PlacedProfileAxis&) const = default;
};

class ProfileMap : public UnitMap {
public:
    struct Setup {
        std::shared_ptr<const Language> language;
        MapWordOrder word_order = MapWordOrder::high_first;
        std::vector<PlacedProfileAxis> axes;
        MapGaps gaps = MapGaps::zero;
    };

    Verdict check_read(Table table, std::uint16_t address, std::uint16_t count) override;
    Verdict read_registers(Table table, std::uint16_t address, std::uint16_t count, Instant now, std::uint8_t* out) override;
    Verdict read_bits(Table table, std::uint16_t address, std::uint16_t count, std::uint8_t* out) override;
    Verdict check_write(Table table, std::uint16_t address, std::uint16_t count) override;
    Verdict write(Table table, std::uint16_t address, std::uint16_t count, const std::uint8_t* data, WritePlan& plan) override;

    std::vector<MapValue> values(Table table, std::uint16_t address, std::uint16_t count, bool written) override;
    void show(Table table, std::uint16_t address, std::uint16_t count, Instant now, std::uint8_t* out) override;
    [[nodiscard]] bool takes_images() const noexcept override { return true; }
    void adopt(Table table, std::uint16_t address, std::uint16_t count, const std::uint8_t* data, WritePlan& plan) override;
    void renew(Table table, std::uint16_t address, std::span<const MapValue> changed, const std::uint8_t* data, WritePlan& plan,
               std::vector<Refused>& refused) override;

    [[nodiscard]] const Language& language() const noexcept { return *setup_.language; }

protected:
    /// A row that a client writes, and the written bits.
    struct Written {
        std::size_t row;  ///< index in language().rows
        std::uint32_t bits;
    };
    ProfileMap(const DoorPort& port, Setup setup);

    /// The bits that a row shows now; false if this drive does not provide the value.
    virtual bool shown(std::size_t row, Instant now, std::uint32_t& bits) = 0;
    /// Called when a value of a write is out of its row's range, for the language's own error word.
    virtual void out_of_range() {}
    /// Applies a write: rows in order of their addresses, each within its range. Unless the verdict is good, nothing has changed.
    virtual Verdict taken(std::span<const Written> rows, WritePlan& plan) = 0;

    /// Applies the first image of a client that renews one: set bits count as set before, and only cleared ones that switch off may act. It
    /// is like `taken`, but rows that do not exist or are out of range have been left out.
    virtual void adopted(std::span<const Written> rows, WritePlan& plan) = 0;

    [[nodiscard]] std::size_t axes() const noexcept { return setup_.axes.size(); }
    [[nodiscard]] const PlacedProfileAxis& axis(std::size_t i) const { return setup_.axes[i]; }
    [[nodiscard]] const AxisPicture& picture(std::size_t i) const { return port_.image().picture(setup_.axes[i].id); }
    [[nodiscard]] bool flag(std::size_t i, std::uint16_t f) const { return (picture(i).flags & f) != 0; }
    [[nodiscard]] bool enabled(std::size_t i) const;
    [[nodiscard]] double position(std::size_t i) const { return static_cast<double>(picture(i).position) / axis(i).increments_per_count; }
    [[nodiscard]] double velocity(std::size_t i) const { return static_cast<double>(picture(i).velocity) / axis(i).increments_per_count; }
    /// Converts counts to increments, rounded and limited to 64 bits.
    [[nodiscard]] std::int64_t increments(std::size_t i, double counts) const;
    /// A speed or ramp in counts as increments, at least 1.
    [[nodiscard]] std::int64_t positive_increments(std::size_t i, double counts) const {
        return std::max<std::int64_t>(1, increments(i, counts));
    }
    [[nodiscard]] Instant now() const { return port_.now(); }
    enum class Answer : std::uint8_t {
        client,        ///< the client waits for the result; the map gets it, too
        acknowledged,  ///< only the map gets the result, when the drive has acknowledged
        done           ///< only the map gets the result, when the command is done
    };
    void order(WritePlan& plan, std::size_t i, CommandBody body, std::uint32_t note, Answer answer) const;
    Verdict refused(std::size_t i, Reason reason, std::string text);

    const Setup setup_;

private:
    /// The bits of a row in an image; false if they are not a number, or out of its range.
    [[nodiscard]] bool bits_in(const LanguageRow& row, const std::uint8_t* at, std::uint32_t& bits);
    void put_bits(const LanguageRow& row, std::uint32_t bits, std::uint8_t* at) const noexcept;
    template <class F>
    Verdict each(Table table, std::uint16_t address, std::uint16_t count, bool writing, F&& f);
    [[nodiscard]] bool there(const LanguageRow& row, Table table) const noexcept;

    const DoorPort& port_;
    std::vector<Written> written_;  // kept, so that no memory is allocated for a write
};

/// A number, limited to 32 bits, as bits of a register's type.
[[nodiscard]] std::uint32_t bits_of(MapType type, double value) noexcept;
/// Bits of a register's type as a number.
[[nodiscard]] double number_of(MapType type, std::uint32_t bits) noexcept;

[[nodiscard]] std::unique_ptr<ProfileMap> make_profile(ProfileLanguage language, const DoorPort& port, ProfileMap::Setup setup);

}  // namespace axisgate::registers
