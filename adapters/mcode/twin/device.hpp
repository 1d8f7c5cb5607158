// Device: one Lexium drive: link, language, memory and motor put together as a Twin.
// In: bytes, time, the tester's hand. Out: bytes, the non-volatile memory.
// Never blocks: a typed line takes `execution` (Manners), a program `slice_time` for some lines, and one call runs a bounded number of
// them.
#pragma once

#include <deque>
#include <memory>
#include <string>
#include <vector>

#include "adapters/mcode/twin/awaited.hpp"
#include "adapters/mcode/twin/delivery.hpp"
#include "adapters/mcode/twin/pace.hpp"
#include "adapters/mcode/twin/program_mode.hpp"
#include "adapters/mcode/twin/tracer.hpp"
#include "adapters/mcode/twin/trip_table.hpp"
#include "gateway/core/hand_table.hpp"
#include "gateway/core/twin.hpp"

namespace axisgate::mcode::twin {

/// A stored program runs in slices of 1 ms with 20 lines each: 50 us per line. The manual gives no figure.
inline constexpr Duration slice_time = std::chrono::milliseconds(1);
inline constexpr int lines_per_slice = 20;
/// What one late call makes up for, each at its own instant; what is older than that many is done at the instant of the call.
inline constexpr int events_per_call = 20'000;
/// Typed lines that wait; one more is error 63 and lost.
inline constexpr std::size_t waiting_lines = 8;

struct DeviceSetup {
    std::uint8_t product = lmdc;
    bool ethernet = false;
    std::uint32_t bit_rate = 0;  ///< of the line; 0: every rate fits
    char name = '!';             ///< anything else: DN is that, and PY = 1, in the state the drive comes with
    bool pad = false;            ///< PF fills up to its width (E-12)
    bool base_two = false;       ///< LO has base 2, else it is the natural logarithm (E-15)
    std::string part_number = "LMDCM571";
    std::string serial_number = "0000000001";
    Manners manners{};
    std::vector<int> codes;  ///< errors that a hand can inject; empty: all numbers

    /// 37 for a word that this drive does not have, else 0.
    [[nodiscard]] int available(Word word) const noexcept;
    /// The error of a line that has a word of a later firmware; 0: it has none.
    [[nodiscard]] int too_new(std::string_view text) const;
    /// VR.
    [[nodiscard]] std::string version_text() const;
};

/// ER and EF.
struct ErrorState {
    int code = 0;
    bool flag = false;

    void set(int c) noexcept {
        code = c;
        flag = true;
    }
};

class Device final : public Twin, private Host {
public:
    Device(DeviceSetup setup, std::unique_ptr<Mechanism> motor);

    void on_frame(const Frame& frame, Instant now, Out& out) override;
    void on_deadline(Instant now, Out& out) override;
    [[nodiscard]] Instant deadline() const override;
    void power_on(const NonVolatile& memory, Instant now, Out& out) override;
    [[nodiscard]] NonVolatile non_volatile() const override { return nvm_; }
    [[nodiscard]] std::uint64_t non_volatile_revision() const override { return nvm_revision_; }
    [[nodiscard]] std::vector<HandItem> hand() const override;
    [[nodiscard]] std::string set_hand(const std::string& name, const Value& value, Instant now, Out& out) override;
    [[nodiscard]] TwinMechanics mechanics(int channel, Instant now) const override;

private:
    // Host
    Number read(Word word, int& error) override;
    int write(Word word, std::span<const Number> fields) override;
    int perform(const Statement& s, std::span<const Number> fields) override;
    bool moving() override { return motor_->moving(now_); }

    // device.cpp: time, link
    void pass_until(Instant now, Out& out);
    void settle(Out& out);
    [[nodiscard]] Instant due() const;
    void take_events();
    void run_command(const Command& command);
    void run_slice(Instant at);
    void say(std::string_view text);
    [[nodiscard]] bool deaf() const noexcept;
    // hand.cpp
    static const HandRow<Device> conditions[];
    // exec.cpp, program_device.cpp, print.cpp: words and instructions
    using Fields = std::span<const Number>;
    /// An instruction that is one step, and how it is carried out: 0, or its error.
    struct Instruction {
        Word word;
        int (*carry_out)(Device&, const Statement&, Fields);
    };
    static const Instruction instructions[];
    void raise(int code);
    int typed(std::string_view text);
    int print(const Statement& s);
    int run_program(const Target& target, Tracer::Mode mode);
    int execute_label(const Statement& s, std::span<const Number> fields);
    int clear_program(const Statement& s, std::span<const Number> fields);
    int enter_program_mode(std::span<const Number> fields);
    int list(const Statement& s);
    int declare(const Statement& s, std::span<const Number> fields);
    [[nodiscard]] std::optional<std::string> text_of_word(Word word, int& error);
    [[nodiscard]] std::string all_values();
    void fire(Word trip);
    void stop_program();
    void stop_everything();
    // memory.cpp: RAM against NVM
    void boot();
    void factory_state(bool as_delivered);
    /// S and FD.
    void keep();
    void restore(const NonVolatile& memory, bool programs);

    DeviceSetup setup_;
    std::unique_ptr<Mechanism> motor_;
    Comm comm_;
    Program program_;
    Run run_;
    ProgramMode program_mode_{program_, (setup_.product & lmm) != 0};
    Tracer tracer_{program_, comm_};
    TripTable trips_{program_, *motor_};
    Awaited awaited_{program_, run_};

    Instant now_{};
    Pace pace_{setup_.manners};
    Transmitter tx_{setup_.bit_rate};
    std::string* data_ = nullptr;  ///< where PR and L of a typed line write; null: program output
    bool data_ended_ = true;
    bool data_given_ = false;
    std::deque<Command> waiting_;
    Instant command_due_ = never;
    Instant slice_due_ = never;

    // registers of the language
    ErrorState error_;
    int bd_ = 96;
    std::uint32_t active_rate_ = 0;
    bool lk_ = false;
    bool lk_saved_ = false;
    bool ne_ = false;
    bool radians_ = true;
    PrintFormat format_;
    std::array<std::int64_t, 4> pw_{};
    std::optional<Target> on_error_;

    // program
    bool paused_ = false;
    bool ending_ = false;    ///< E was typed: ends when the motion is over
    bool announce_ = false;  ///< second field of MA, MR: DN at the end
    bool upgrading_ = false;

    NonVolatile nvm_;
    std::uint64_t nvm_revision_ = 0;
    bool powered_ = false;
    bool address_input_ = false;  ///< LMM: one of the hardware address inputs is active, and PY stays 1 [L5016]
};

}  // namespace axisgate::mcode::twin
