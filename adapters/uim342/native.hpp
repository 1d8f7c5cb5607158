// Native: the drive's own language for people: "MO=1", "MT[0]", "JV=-1000", or the bytes of abstract messages.
// In: text or bytes that a person wrote; messages. Out: messages, or what is wrong with the text; one readable line per message.
// Never sends, never completes a value that was not written.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "adapters/uim342/wire.hpp"
#include "gateway/core/catalogue.hpp"
#include "gateway/core/family.hpp"

namespace axisgate::uim342 {

/// At most this many instructions in one native command.
inline constexpr std::size_t native_limit = 4;

struct NativeScript {
    std::vector<Message> messages;  ///< for the node, in order
    std::string fault;              ///< empty: good
};

/// `MO=1`, `PR`, `MT[0]=16`, `MF=3;AC=1000`: mnemonics in any case, numbers decimal or 0x, separated by `;`. All with acknowledgement.
[[nodiscard]] NativeScript parse_native(std::uint8_t node, std::string_view text);
/// `CW DL d0..` once or several times, as bytes; CW with or without the acknowledge bit, as the writer wants it.
[[nodiscard]] NativeScript parse_native(std::uint8_t node, std::span<const std::uint8_t> bytes);

/// The line that an action of the family is: an instruction by its id or name, and what follows it. Empty: there is no such action.
[[nodiscard]] std::string script_of(const Action& action, const Catalogue& catalogue);
/// Family::stated. AC and DC are read as pulse/s^2, as the factory has IC[4]; values of an input's group (MF) set nothing for other
/// motions.
[[nodiscard]] Stated stated(const Catalogue& catalogue, int channel, const CommandBody& body);

/// "PP[5]", "MO".
[[nodiscard]] std::string name_of_request(std::uint8_t cw, std::uint8_t index);
/// An instruction as a person would write it: "JV=-1000".
[[nodiscard]] std::string describe_request(const Message& m);
/// What a device said: "MO = 1 (driver on)", "error 0x33 (data error) about PP[5]", "notification: IN1 rising".
[[nodiscard]] std::string describe_answer(const Message& m);
/// "0x33 (data error)".
[[nodiscard]] std::string describe_error(std::uint8_t code);
/// "11 08 00 3D ..." of CW, DL and the data.
[[nodiscard]] std::string hex_of(const Message& m);

}  // namespace axisgate::uim342
