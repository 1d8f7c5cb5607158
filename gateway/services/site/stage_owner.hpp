// The owner of the staged site: its id for clients, the client and time of the staging, and the client that applied it. There is one stage
// at most, as in the stage port. The stage itself is not changed here.
#pragma once

#include <cstdint>
#include <string>

#include "gateway/core/command.hpp"
#include "gateway/site/site_stage.hpp"

namespace axisgate {

class StageOwner {
public:
    bool confirming = false;  ///< the disk was asked to keep the applied site

    StageOwner();

    /// "k3f9Qa-2": differs for each stage, also between runs of the program.
    [[nodiscard]] std::string id(const SiteStage& stage) const;
    void staged(const SiteStage& stage, const Origin& by, std::int64_t at_unix_ns);
    /// `session` is the one in which the client is signed in (session_of); the same user in another session counts as another one.
    void applied(const SiteStage& stage, const Origin& by, std::string session);
    /// Empty for a stage that was made before this object existed.
    [[nodiscard]] const std::string& stager(const SiteStage& stage) const;
    [[nodiscard]] const std::string& applier(const SiteStage& stage) const;
    [[nodiscard]] const std::string& applier_session(const SiteStage& stage) const;
    [[nodiscard]] std::int64_t at_unix_ns(const SiteStage& stage) const { return stage.id() == serial_ ? at_unix_ns_ : 0; }

private:
    std::string run_;  // of this run of the program
    std::uint64_t serial_ = 0;
    std::int64_t at_unix_ns_ = 0;
    std::string stager_, applier_;  // clients, named as in leases
    std::string applier_session_;
};

}  // namespace axisgate
