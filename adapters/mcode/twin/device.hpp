// Device: one Lexium drive: link, language, memory and motor put together as a Twin.
// In: bytes, time, the tester's hand. Out: bytes, the non-volatile memory.
// Never blocks: a typed line takes `command_time`, a program `statement_time` per line, and one call runs a bounded number of them.
#pragma once

#include <deque>
#include <memory>
#include <string>
#include <vector>

#include "adapters/mcode/twin/comm.hpp"
#include "adapters/mcode/twin/mechanism.hpp"
#include "adapters/mcode/twin/run.hpp"
#include "gateway/core/twin.hpp"

namespace axisgate::mcode::twin {

/// Execution of a typed line: 1 ms, the short end of the 1-5 ms of the manual [L6821].
inline constexpr Duration command_time = std::chrono::milliseconds(1);
/// A stored program runs in slices of 1 ms with 20 lines each: 50 us per line. The manual gives no figure.
inline constexpr Duration slice_time = std::chrono::milliseconds(1);
inline constexpr int lines_per_slice = 20;
/// What one late call makes up for, each at its own instant; what is older than that many is done at the instant of the call.
inline constexpr int events_per_call = 20'000;
/// Typed lines that wait; one more is error 63 and lost.
inline constexpr std::size_t waiting_lines = 8;
/// Bytes of program output that wait for the line; more is error 66 and lost.
inline constexpr std::size_t transmit_buffer = 256;

struct DeviceSetup {
    std::uint8_t product = lmdc;
    bool ethernet = false;
    std::uint32_t bit_rate = 0;  ///< of the line; 0: every rate fits
    char name = '!';             ///< anything else: DN is that, and PY = 1, in the state the drive comes with
    bool pad = false;            ///< PF fills up to its width (E-12)
    bool base_two = false;       ///< LO has base 2, else it is the natural logarithm (E-15)
    std::string part_number = "LMDCM571";
    std::string serial_number = "0000000001";
    std::vector<int> codes;  ///< errors that a hand can inject; empty: all numbers
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
    enum class Mode : std::uint8_t { normal, trace, step };
    struct Trip {
        bool defined = false;
        Target target;
        std::int64_t repeats = 0;  ///< TR: 0 endless
        std::int64_t left = 0;     ///< of this series
        std::int64_t ms = 0;       ///< TT
    };

    // Host
    Number read(Word word, int& error) override;
    int write(Word word, std::span<const Number> fields) override;
    int perform(const Statement& s, std::span<const Number> fields) override;
    bool moving() override { return motor_->moving(now_); }

    // twin_device.cpp: time, link
    void pass_until(Instant now, Out& out);
    void settle(Out& out);
    [[nodiscard]] Instant due() const;
    void take_events();
    void run_command(const Command& command);
    void run_slice(Instant at);
    void flush(Out& out);
    void say(std::string_view text);
    [[nodiscard]] bool deaf() const noexcept;
    [[nodiscard]] int available(Word word) const noexcept;
    // twin_exec.cpp, twin_program_device.cpp, twin_print.cpp: words and instructions
    void raise(int code);
    void clear_error();
    int typed(std::string_view text);
    int program_line(std::string_view text);
    int print(const Statement& s);
    int run_program(const Target& target, Mode mode);
    int execute_label(const Statement& s, std::span<const Number> fields);
    int set_trip(const Statement& s, std::span<const Number> fields);
    int enable_trips(std::int64_t mask);
    int clear_program(const Statement& s, std::span<const Number> fields);
    int enter_program_mode(std::span<const Number> fields);
    int list(const Statement& s);
    int declare(const Statement& s, std::span<const Number> fields);
    int break_point(const Statement& s, std::span<const Number> fields);
    int input_value(std::string_view text);
    [[nodiscard]] std::optional<std::string> text_of_word(Word word, int& error);
    [[nodiscard]] std::string all_values();
    void fire(Word trip);
    void stop_program();
    void stop_everything();
    // twin_memory.cpp: RAM against NVM
    void boot();
    void factory_state(bool as_delivered);
    [[nodiscard]] NonVolatile snapshot() const;
    void restore(const NonVolatile& memory, bool programs);
    int save();
    [[nodiscard]] std::uint32_t rate_of_code(int code) const noexcept;

    DeviceSetup setup_;
    std::unique_ptr<Mechanism> motor_;
    Comm comm_;
    Program program_;
    Run run_;

    Instant now_{};
    std::string tx_;               ///< leaves with the present call
    std::string* data_ = nullptr;  ///< where PR and L of a typed line write; null: program output
    bool data_ended_ = true;
    bool data_given_ = false;
    std::deque<Command> waiting_;
    Instant command_due_ = never;
    Instant slice_due_ = never;
    Instant transmit_free_{};

    // registers of the language
    int er_ = 0;
    bool ef_ = false;
    int bd_ = 96;
    std::uint32_t active_rate_ = 0;
    bool lk_ = false;
    bool lk_saved_ = false;
    bool ne_ = false;
    bool radians_ = true;
    PrintFormat format_;
    std::array<std::int64_t, 4> pw_{};
    std::optional<Target> on_error_;
    std::array<Trip, 7> trips_{};  ///< by bit of TE
    int te_ = 0;
    Instant trip_time_ = never;

    // program
    bool programming_ = false;
    std::int32_t program_address_ = 1;
    bool paused_ = false;
    bool ending_ = false;  ///< E was typed: ends when the motion is over
    Mode mode_ = Mode::normal;
    bool step_now_ = false;
    std::optional<Target> break_at_;
    std::int64_t break_count_ = 0;
    bool input_pending_ = false;
    Word input_word_{};
    SymbolId input_symbol_ = no_symbol;
    bool announce_ = false;  ///< second field of MA, MR: DN at the end
    bool upgrading_ = false;

    NonVolatile nvm_;
    std::uint64_t nvm_revision_ = 0;
    bool powered_ = false;
    bool silent_ = false;
    bool address_input_ = false;  ///< LMM: one of the hardware address inputs is active, and PY stays 1 [L5016]
};

}  // namespace axisgate::mcode::twin
