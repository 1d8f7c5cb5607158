// The parameter port: the newest reported value of each parameter, and the stored writes. Bounded: one value per parameter of the site's
// axes. Values of a former drive of an axis are not shown.
#pragma once

#include <unordered_map>
#include <vector>

#include "gateway/runtime/warm_threads.hpp"
#include "gateway/services/ports/axes.hpp"
#include "gateway/services/ports/parameters.hpp"
#include "gateway/services/ports/site.hpp"

namespace axisgate {

class WarmParameters final : public ParameterPort, public SiteListener {
public:
    WarmParameters(const WarmThreads& threads, const AxisPort& axes);
    /// The mailbox for the reports of drives.
    [[nodiscard]] Mailbox<Sample>& samples() noexcept { return samples_; }
    void on_site(const std::shared_ptr<const SiteState>& site) override;

    [[nodiscard]] LiveParameter live(AxisId axis, Point point) const override;
    [[nodiscard]] std::vector<StoredParameter> stored(const std::string& axis) const override;
    [[nodiscard]] std::vector<StoredParameter> history(const std::string& axis, const std::string& parameter,
                                                       std::size_t limit) const override;
    void listen(SampleListener* listener) override { listeners_.push_back(listener); }
    void unlisten(SampleListener* listener) override { std::erase(listeners_, listener); }

private:
    /// The value with its origin (AxisPicture::source) and time.
    struct Reported {
        LiveParameter what;
        std::uint32_t source = 0;
        Instant at{};
    };
    void take(Sample&& sample);

    const WarmThreads& threads_;
    const AxisPort& axes_;
    Mailbox<Sample> samples_;
    std::vector<SampleListener*> listeners_;
    std::unordered_map<std::uint64_t, Reported> live_;  // by axis << 32 | parameter << 16 | element
};

}  // namespace axisgate
