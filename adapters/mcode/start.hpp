// Start: finding a drive, setting how it speaks (EM, CK, ES, CE), reading what it is; and losing it.
// In: the ends of probes, link lines and first questions; silences. Out: requests, links, what the model has.
// Never sets a rate by itself: BD acts at the next restart only, so what will go wrong is told while the drive can still be heard.
#pragma once

#include <string>
#include <string_view>

#include "adapters/mcode/drive_part.hpp"

namespace axisgate::mcode {

class Start : public Part {
public:
    static constexpr int link_round_limit = 8;  ///< lines that set its link in a row; what it has then is used as it is
    using Part::Part;

    void probe_anew(Turn& t);
    void again(Turn& t) noexcept;  ///< the next probe is due at once
    /// Its questions are refused: a restart has brought back EM and CK of its memory.
    void link_changed(Turn& t);
    void silent(Turn& t);  ///< an exchange has had no answer
    void lose(std::string why, Turn& t);
    void lose_longer(std::string why, Turn& t);
    [[nodiscard]] std::string not_understood() const;

    [[nodiscard]] Request next();
    /// It is answered by an acknowledgement alone.
    /// Of the page's "products": "lmdo", "lmdc", "lmm"; empty: its part number does not say it.
    [[nodiscard]] std::string_view product() const noexcept;
    [[nodiscard]] bool says_line() const noexcept { return !link_line_.empty(); }
    void ended(Verdict v, const ReplyReader& r, bool mode_line, Turn& t);
    /// Every exchange: what came, whatever it was for.
    void received(Verdict v, const ReplyReader& r) noexcept;

    [[nodiscard]] std::string rate_trouble() const;
    [[nodiscard]] std::string factory_hint() const;
    void rate_set() noexcept;  ///< BD is as the line wants it
    void at_factory_rate() noexcept { at_factory_rate_ = true; }

private:
    void probe_answered(const std::string& data, Turn& t);
    [[nodiscard]] std::string wanted_word() const;
    void read(Verdict v, std::string data, Turn& t);
    [[nodiscard]] bool needless(std::string_view item) const noexcept;
    void came(Turn& t);

    Duration pause_{};     ///< between the probes of a drive that is away; 0 when it was ready
    int spoiled_ = 0;      ///< answers in a row that nobody understands
    bool babble_ = false;  ///< the last exchange without an answer was not without bytes
    int link_rounds_ = 0;
    std::string link_line_;  ///< EM=, CK=, ES=, CE= to be sent next
    std::string unproven_;   ///< the last such line, if nobody has acknowledged it
    bool unproven_at_once_ = false;
    std::size_t item_ = 0;  ///< of what is read
    std::string identity_;
    bool knows_model_ = false;      ///< by its part number
    bool running_ = false;          ///< a program, as it was found
    int bd_ = 0;                    ///< BD as the drive has it; it acts at the next restart
    bool at_factory_rate_ = false;  ///< FD was sent since it was heard last
};

}  // namespace axisgate::mcode
