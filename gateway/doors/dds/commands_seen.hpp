// Remembers the commands that arrived over DDS with their one result, so that a repeated command is answered and not carried out again.
// None is forgotten within `keep_for`; if there is no space, a new one is refused.
#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <string>
#include <unordered_map>
#include <utility>

#include "gateway/core/command.hpp"

namespace axisgate::dds {

class CommandsSeen {
public:
    static constexpr std::size_t most = 4096;
    static constexpr Duration keep_for = std::chrono::minutes(10);  ///< after its result; a command's own lifespan is 2 s

    enum class Stage : std::uint8_t { is_new, under_way, answered, no_room };
    struct Seen {
        Stage stage = Stage::is_new;
        const Result* result = nullptr;  ///< of an answered one; valid until the next call
    };
    /// If less than this number is free, a sender with an eighth of all places gets no further one, so that one member cannot use up the
    /// places of others.
    static constexpr std::size_t kept_for_others = most / 4, share = most / 8;
    /// A command has arrived from `writer`. `is_new`: it is recorded as in progress, and end() follows.
    [[nodiscard]] Seen begin(const std::string& source, const std::string& id, Instant now, std::uint64_t writer = 0);
    /// Its one result.
    void end(const std::string& source, const std::string& id, Result result, Instant now);
    [[nodiscard]] std::size_t size() const noexcept { return kept_.size(); }

private:
    struct Kept {
        bool answered = false;
        Result result;
        std::uint64_t writer = 0;
    };
    void forget(const std::string& key);
    /// The separator cannot occur in either part, because texts of the IDL end at a zero.
    [[nodiscard]] static std::string key_of(const std::string& source, const std::string& id) { return source + '\0' + id; }

    std::unordered_map<std::string, Kept> kept_;
    std::unordered_map<std::uint64_t, std::size_t> held_;  // by writer
    std::deque<std::pair<Instant, std::string>> ended_;    // in order of their results
};

}  // namespace axisgate::dds
