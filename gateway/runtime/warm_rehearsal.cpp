// One cell is one job with copies of the site and of the twins' memories; nothing is shared with the gateway's own engine.
#include "gateway/runtime/warm_rehearsal.hpp"

#include <sched.h>

#include <boost/asio/post.hpp>

#include "gateway/engine/rehearsal.hpp"
#include "gateway/runtime/site_file.hpp"

namespace axisgate {
namespace {
/// Lowers the priority below that of all other threads. If this is refused, the rehearsal is played all the same.
void stand_back() {
    const sched_param none{};
    (void)sched_setscheduler(0, SCHED_IDLE, &none);
}
}  // namespace

WarmRehearsal::~WarmRehearsal() {
    thread_.stop();
    thread_.join();
}

void WarmRehearsal::rehearse(std::shared_ptr<const SiteState> site, RehearsalWish wish, std::function<void(RehearsalCell)> then) {
    wish.watchdog = watchdog_;
    wish.lease = lease_;
    auto memory = read_site_memory(threads_.reader, site->site);
    boost::asio::post(thread_,
                      [this, site = std::move(site), memory = std::move(memory), wish = std::move(wish), then = std::move(then)]() mutable {
                          stand_back();
                          auto cell = axisgate::rehearse(families_, site->site, memory, wish);
                          threads_.answer([then = std::move(then), cell = std::move(cell)]() mutable { then(std::move(cell)); });
                      });
}

}  // namespace axisgate
