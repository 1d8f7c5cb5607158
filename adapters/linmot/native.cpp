// A telegram that the client has written: "sub main data..." in hex, or bytes (the same, or a complete telegram for this ID). ID, length
// and frame are added here. A motion command whose count did not change is sent, and the answer states that it was not executed.
#include "adapters/linmot/native.hpp"

#include <fmt/format.h>

#include "adapters/linmot/drive.hpp"
#include "gateway/core/text.hpp"

namespace axisgate::linmot {

std::optional<std::vector<std::uint8_t>> native_bytes(std::span<const std::uint8_t> text) {
    std::string digits(text.begin(), text.end());
    std::erase_if(digits, [](char c) { return c == ' ' || c == ',' || c == '\t' || c == '\r' || c == '\n'; });
    return from_hex(digits);
}

std::optional<Telegram> NativeTelegram::request(Turn& t) {
    const auto& native = std::get<Native>(job().command.body);
    const Status& status = drive_.feedback.status();
    const auto wrong = [&](std::string text) { return refused(Reason::out_of_range, std::move(text), t); };
    const auto bytes = native.is_text ? native_bytes(native.send) : std::optional(native.send);
    if (!bytes || bytes->size() < 2)
        return wrong("write sub ID, main ID and data as pairs of hex digits: \"01 00\" asks for the default response");
    Telegram telegram;
    const auto& b = *bytes;
    const std::size_t tail = drive_.bus.checksum.size();
    if (b.size() >= 7 && b[0] == 1 && b[3] == 2 && b.back() == 4 && b.size() == std::size_t{b[2]} + 4 + tail) {
        Framer framer;
        framer.set(drive_.bus.checksum);
        bool found = false;
        framer.push(b, [&](const Telegram& x, std::span<const std::uint8_t>) { telegram = x, found = true; }, {});
        if (!found) return wrong("the telegram's checksum is wrong");
        if (telegram.id != drive_.id())
            return wrong(fmt::format("the telegram is for ID {}, and drive {} is asked", telegram.id, drive_.title()));
    } else {
        if (b.size() > 2 + Telegram::most_data) return wrong(fmt::format("a telegram has at most {} bytes of data", Telegram::most_data));
        telegram = linmot::request(drive_.id(), Main::response, b[0]);
        telegram.main = b[1];
        for (std::size_t i = 2; i < b.size(); ++i)
            telegram.add(b[i]);
    }
    if (telegram.main == static_cast<std::uint8_t>(Main::motion) && telegram.size >= 2 && status.state() == state::enabled &&
        (telegram.u16(0) & 0x0F) == (status.sub_state() & 0x0F))
        job().text = fmt::format(" (the count is {} as before: the drive has not executed it)", telegram.u16(0) & 0x0F);
    if (telegram.main == static_cast<std::uint8_t>(Main::control_word)) drive_.control.forget();
    if (telegram.main == static_cast<std::uint8_t>(Main::motion)) drive_.motion.no_orphan();
    if (telegram.main == static_cast<std::uint8_t>(Main::motion) || telegram.main == static_cast<std::uint8_t>(Main::control_word))
        drive_.demand.forget();
    // Live parameters are written by a motion command, others by the messages of their group, all of them by a restart.
    const auto main = static_cast<Main>(telegram.main);
    job().number = main == Main::motion || main == Main::parameters || main == Main::program ? 1 : 0;
    return telegram;
}

void NativeTelegram::answered(const Telegram& telegram, Turn& t) {
    if (job().number != 0) drive_.start.read_again();
    job().bytes = pack(telegram, drive_.bus.checksum);
    std::string text;
    for (const auto b : job().bytes)
        fmt::format_to(std::back_inserter(text), "{}{:02X}", text.empty() ? "" : " ", b);
    succeed(text + job().text, t);
}

}  // namespace axisgate::linmot
