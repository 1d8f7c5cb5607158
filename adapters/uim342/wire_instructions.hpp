// Instructions of the UIM342: the table of its 29 control words, and which answer belongs to which instruction.
// In: messages. Out: rows of the table, messages built from names and numbers, and the verdict on an arriving message.
// Never keeps what was sent: the caller brings the request. GET and SET share a control word; DL alone tells them apart.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "adapters/uim342/wire.hpp"

namespace axisgate::uim342 {

/// What the data word after the sub-index is.
enum class Data : std::uint8_t { none, u8, u16, u32, i32, raw };
[[nodiscard]] std::uint8_t width_of(Data data) noexcept;  ///< bytes; 0 for none and raw

/// What answers a SET (or a "do") that asked for an acknowledgement [L510 and chapter 5].
enum class SetAnswer : std::uint8_t {
    none,     ///< there is no SET
    echo,     ///< own control word with the same bytes
    desired,  ///< DV[2], DV[3] or DV[4] instead: JV SP PR PA
    done,     ///< own control word, content does not matter: BG ST OG
    status,   ///< a whole MS[0]
    report,   ///< an ER[i]
    image,    ///< DI: inputs and output, not the bytes that were sent
    silent    ///< nothing, ever: SY
};

/// When a SET gets into the memory that survives a power cycle.
enum class Storage : std::uint8_t {
    none,        ///< nothing to keep
    flash,       ///< at once, whatever MO is; acts after a reboot: PP [L1064]
    eeprom,      ///< always: IC (erratum E-33)
    eeprom_off,  ///< only while the driver is off; else RAM alone
    ram
};

struct Instruction {
    std::uint8_t cw = 0;
    std::string_view name;  ///< mnemonic
    std::string_view title;
    bool indexed = false;     ///< d0 is the sub-index i
    std::int8_t get_dl = -1;  ///< DL of the GET; -1: none
    std::int8_t set_dl = -1;  ///< DL of the SET or "do"; -1: none
    Data data = Data::none;   ///< after the sub-index
    SetAnswer answer = SetAnswer::none;
    Storage storage = Storage::none;
    bool repeatable = true;  ///< a SET may be sent again when its answer is missing
    bool grouped = false;    ///< has values of its own for each input edge, chosen by MF (AC DC SP PR PA)
    bool takes_mf = false;   ///< uses up a selection made by MF: the grouped ones and SS SD JV BL (erratum E-13)
    std::span<const std::uint8_t> indices{};
};

/// All rows in the order of the manual's summary; RT included.
[[nodiscard]] std::span<const Instruction> all_instructions() noexcept;
/// By control word, bit 7 ignored; nullptr if the manual has none.
[[nodiscard]] const Instruction* instruction(std::uint8_t cw) noexcept;
/// By mnemonic, any case; nullptr if there is none.
[[nodiscard]] const Instruction* instruction_named(std::string_view name) noexcept;

enum class Form : std::uint8_t { unknown, get, set };
/// What an instruction's DL makes of it; short data words of the non-indexed 32-bit instructions are SETs (erratum E-10).
[[nodiscard]] Form form_of(const Message& request) noexcept;

/// Smallest and largest value that the data word of a SET can carry.
struct Range {
    std::int64_t min = 0;
    std::int64_t max = 0;
};
[[nodiscard]] Range range_of(Data data) noexcept;

/// GET with acknowledgement. `index` is ignored where the instruction has none.
[[nodiscard]] Message make_get(std::uint8_t node, const Instruction& i, std::uint8_t index = 0) noexcept;
/// SET (or "do") with acknowledgement; the value must be in range_of(i.data). DI: the output level, 0 or 1.
[[nodiscard]] Message make_set(std::uint8_t node, const Instruction& i, std::uint8_t index, std::int64_t value) noexcept;
/// Shorthands for the adapter's own sequences.
[[nodiscard]] Message get(std::uint8_t node, std::uint8_t cw, std::uint8_t index = 0) noexcept;
[[nodiscard]] Message set(std::uint8_t node, std::uint8_t cw, std::int64_t value, std::uint8_t index = 0) noexcept;
[[nodiscard]] Message act(std::uint8_t node, std::uint8_t cw) noexcept;  ///< BG ST OG

/// The number in an answer to `request` (GET or SET); nothing for raw answers (ML SN ER MS).
[[nodiscard]] std::optional<std::int64_t> value_of(const Message& request, const Message& answer) noexcept;

/// What an arriving message is to an outstanding instruction.
enum class Match : std::uint8_t {
    no,      ///< not its answer
    answer,  ///< its answer
    error,   ///< the drive refused it: CW 0F with our control word in d2
    torn     ///< would be its answer, but is too short to be read
};
[[nodiscard]] Match match(const Message& request, const Message& arrived) noexcept;
/// Whether an answer repeats the value that was sent. True for everything that does not echo.
[[nodiscard]] bool echoes(const Message& request, const Message& answer) noexcept;

/// What an answer looks like from outside: two instructions with the same mark cannot be told apart by their answers.
[[nodiscard]] std::uint16_t mark_of(const Message& request) noexcept;

/// An error report (CW 0F): code, control word and sub-index it is about [L557-575].
struct ErrorReport {
    std::uint8_t slot = 0;
    std::uint8_t code = 0;
    std::uint8_t cw = 0;  ///< bit 7 as the drive got it
    std::uint8_t index = 0;
};
/// Nothing if it is shorter than 4 bytes.
[[nodiscard]] std::optional<ErrorReport> error_report_of(const Message& m) noexcept;

}  // namespace axisgate::uim342
