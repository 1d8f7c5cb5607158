// Delivery: how an answer leaves: the pauses in it. And what a drive says and holds that nobody has asked for.
// In: an answer, the drive's manners. Out: text and pauses for the transmitter; a notice; a program.
// Never changes the text of an answer.
#pragma once

#include "adapters/mcode/twin/comm.hpp"
#include "adapters/mcode/twin/program.hpp"
#include "adapters/mcode/twin/transmitter.hpp"

namespace axisgate::mcode::twin {

void deliver(const Reply& reply, bool party, const Manners& manners, Instant now, Transmitter& tx);
/// The notice at power-up and after CTRL+C; empty: this drive gives none.
[[nodiscard]] std::string sign_on(const Manners& manners, const LinkFlags& flags, bool network);
/// A program that somebody has left in the drive: it runs from power-up and prints the position. Nothing without `chatter_ms`.
void load_chatter(const Manners& manners, Program& program);

}  // namespace axisgate::mcode::twin
