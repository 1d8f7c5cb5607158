// Stage owner: whose the staged site is: its id for clients, which client staged it and when, and which client applied it.
// In: the stage, callers, times. Out: ids, and whether a caller is the one. One stage at most, as the stage port has it.
// Never changes the stage: a handler asks here first.
#pragma once

#include <cstdint>
#include <string>

#include "gateway/core/command.hpp"
#include "gateway/site/site_stage.hpp"

namespace axisgate {

class StageOwner {
public:
    bool confirming = false;  ///< the disk is asked to keep the applied site

    StageOwner();

    /// "k3f9Qa-2": another one for each stage, also of other runs of the program.
    [[nodiscard]] std::string id(const SiteStage& stage) const;
    void staged(const SiteStage& stage, const Origin& by, std::int64_t at_unix_ns);
    /// `session`: in which the client is signed in (session_of), so that the same user elsewhere is another one.
    void applied(const SiteStage& stage, const Origin& by, std::string session);
    /// Nothing is known of a stage that it has not seen made.
    [[nodiscard]] const std::string& stager(const SiteStage& stage) const;
    [[nodiscard]] const std::string& applier(const SiteStage& stage) const;
    [[nodiscard]] const std::string& applier_session(const SiteStage& stage) const;
    [[nodiscard]] std::int64_t at_unix_ns(const SiteStage& stage) const { return stage.id() == serial_ ? at_unix_ns_ : 0; }

private:
    std::string run_;  // of this run of the program
    std::uint64_t serial_ = 0;
    std::int64_t at_unix_ns_ = 0;
    std::string stager_, applier_;  // clients, as leases name them
    std::string applier_session_;
};

}  // namespace axisgate
