// A site that is staged, or in force on trial; one at most. A trial always ends: a site that is not confirmed in time is rolled back, also
// after a restart.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "gateway/services/ports/site.hpp"
#include "gateway/site/site_stage.hpp"

namespace axisgate {

class StagePort {
public:
    virtual ~StagePort() = default;
    [[nodiscard]] virtual const SiteStage& site_stage() const = 0;
    /// Each returns an empty text, or the reason for a refusal. Origin names the client; an identity is the same from any port.
    virtual std::string stage_site(Site site, std::uint64_t base_revision, const Origin& origin) = 0;
    virtual std::string discard_stage() = 0;
    /// Puts the staged site in force. `confirm_within_s` 0: permanently; otherwise it is rolled back automatically unless it is confirmed
    /// in that time.
    virtual void apply_stage(std::uint32_t confirm_within_s, Origin origin, std::function<void(SiteAnswer)> then) = 0;
    virtual void confirm_stage(Origin origin, std::function<void(std::string fault)> then) = 0;
    virtual void roll_back_stage(Origin origin, std::function<void(SiteAnswer)> then) = 0;
};

}  // namespace axisgate
