// The stage port: one staged site, its trial, and the roll back. Nothing is rolled back while the disk is asked to confirm; a roll back
// that fails is repeated.
#pragma once

#include <boost/asio/steady_timer.hpp>
#include <string>

#include "gateway/runtime/warm_site.hpp"
#include "gateway/services/ports/stage.hpp"

namespace axisgate {

class WarmStage final : public StagePort {
public:
    WarmStage(const WarmThreads& threads, WarmEvents& events, WarmSite& site)
        : threads_(threads), events_(events), site_(site), trial_(threads.warm) {}

    [[nodiscard]] const SiteStage& site_stage() const override { return stage_; }
    std::string stage_site(Site site, std::uint64_t base_revision, const Origin& origin) override;
    std::string discard_stage() override { return stage_.discard(); }
    void apply_stage(std::uint32_t confirm_within_s, Origin origin, std::function<void(SiteAnswer)> then) override;
    void confirm_stage(Origin origin, std::function<void(std::string fault)> then) override;
    void roll_back_stage(Origin origin, std::function<void(SiteAnswer)> then) override;

private:
    void put_in_force(std::uint32_t confirm_within_s, const Origin& origin, std::function<void(SiteAnswer)> then);
    void arm_trial(std::chrono::nanoseconds from_now);
    void take_back(Origin origin, std::string why, std::function<void(SiteAnswer)> then);
    void refuse(std::string fault, std::function<void(SiteAnswer)> then);

    const WarmThreads& threads_;
    WarmEvents& events_;
    WarmSite& site_;
    SiteStage stage_;
    boost::asio::steady_timer trial_;
    Site trial_base_;          // the site to which an applied stage is rolled back
    bool confirming_ = false;  // the disk is being asked; until it has answered nothing is rolled back
};

}  // namespace axisgate
