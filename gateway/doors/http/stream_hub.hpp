// The live feed without sockets: subscriptions, changes since, and waiting messages of each client. Bounds: topics per client; the queue's
// (the newest state replaces a waiting one; too many events close the client with 1013 and the reason). The WebSocket session reads the
// clock and sends.
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <list>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "gateway/doors/http/counters.hpp"
#include "gateway/doors/http/settings.hpp"
#include "gateway/doors/http/stream_queue.hpp"
#include "gateway/doors/http/stream_request.hpp"
#include "gateway/doors/http/stream_sources.hpp"
#include "gateway/services/frame_decoder.hpp"
#include "gateway/services/ports/events.hpp"
#include "gateway/services/services.hpp"

namespace axisgate::http {

class StreamHub;

/// One client of the live feed, as the hub sees it.
class StreamClient {
public:
    StreamClient(std::size_t max_events, std::function<void()> wake) : queue(max_events), wake_(std::move(wake)) {}

    StreamQueue queue;
    /// Set by the sender: a frame put into an empty queue now is sent at once, before anything newer can come.
    bool takes_at_once = false;
    /// The client for set-points over this feed; empty: its user may not command. Set by the owner of the handshake; not set: nobody may.
    std::function<std::optional<Origin>()> commander;
    /// Not 0: the client must be closed with this code; the close frame is in the queue.
    [[nodiscard]] std::uint16_t closing() const noexcept { return closing_; }
    /// Drops the waiting messages and queues a close frame instead.
    void close(std::uint16_t code, std::string_view reason);

private:
    friend class StreamHub;
    struct Watch {
        std::shared_ptr<Source> source;
        std::uint64_t sent_version = 0;
    };
    struct FrameWatch {
        std::string line, topic;
        std::uint32_t number = 0;
        std::int64_t period_ms = 0;
        LineId id = no_line;      ///< the line to whose recording `since` belongs
        std::uint64_t since = 0;  ///< next sequence number
    };
    std::function<void()> wake_;
    std::map<std::string, std::int64_t, std::less<>> topics_;  ///< as subscribed, with the period in ms
    std::map<std::int64_t, std::vector<Watch>> watches_;       ///< by period
    std::vector<FrameWatch> frames_;
    std::optional<AuthorityClient> gives_set_points_;  ///< the client that has sent set-points over this feed
    bool events_ = false;
    bool site_ = false;
    bool recipes_ = false;
    bool alarms_ = false;
    int wrong_in_a_row_ = 0;
    double asked_ = 0;    ///< use of the client's allowance, see StreamHub::allowance
    Instant asked_at_{};  ///< the instant of it
    std::uint16_t closing_ = 0;
    bool has_work_ = false;  ///< frames were queued since the last wake-up
};

class StreamHub final : public EventListener, public SiteListener, public ServiceListener {
public:
    /// `rearm` is called when deadline() has changed for another reason than on_deadline.
    using Needs = PortSet<AxisPort, ClockPort, DrivePort, EventPort, LinePort, SitePort>;
    StreamHub(const Needs& ports, const Settings& settings, Counters& counters, std::function<void()> rearm);
    ~StreamHub() override;
    /// Stops listening, and sends no more requests.
    void detach();
    [[nodiscard]] bool attached() const noexcept { return attached_; }
    StreamHub(const StreamHub&) = delete;
    StreamHub& operator=(const StreamHub&) = delete;

    /// `wake`: the queue has frames. It may be called from inside any call of the hub; it must not call the hub.
    [[nodiscard]] std::shared_ptr<StreamClient> add(std::function<void()> wake);
    void remove(const std::shared_ptr<StreamClient>& client);
    [[nodiscard]] std::size_t clients() const noexcept { return clients_.size(); }

    /// One text message of a client.
    void on_text(StreamClient& client, std::string_view text, Instant now);
    /// When on_deadline must be called, time_zero: at once; `never` if there are no subscriptions. One call does a few looks or serves one
    /// client, and leaves the rest to the next.
    [[nodiscard]] Instant deadline() const;
    void on_deadline(Instant now);

    /// The report of a run has changed.
    void on_recipe(const std::string& recipe, const boost::json::object& report) override;
    /// Reports of the runs in progress, for new subscribers of `recipes`.
    std::function<std::vector<boost::json::object>()> recipes_now;

    /// The list of alarms has changed.
    void on_alarms(const boost::json::object& list) override;
    /// The present list, for new subscribers of `alarms`.
    std::function<boost::json::object()> alarms_now;

    void on_event(const Event& event) override;
    void on_site(const std::shared_ptr<const SiteState>& site) override;

private:
    static constexpr std::size_t most_topics = 4096;  ///< subscribed by one client
    static constexpr std::size_t first_frames = 200;  ///< of a line, sent at once
    static constexpr std::size_t most_frames = 4096;  ///< in one message
    static constexpr int wrong_requests = 3;          ///< in succession, then the client is closed
    /// States that are made in one call, some 10 us each: a hundred of them, or a hundred clients, take a millisecond and more, during
    /// which no other request would be answered.
    static constexpr int looks_per_slice = 3;
    static constexpr std::size_t most_joined = 128;  ///< states in one write, some 64 KiB
    /// Every subscription sends the whole state again, so a client has an allowance at once and per second. A request costs 1, with 1 more
    /// for each 50 topics, a set-point alone 1/50 (1000 a second), and 4 for each line's frames. Beyond this, the client is closed.
    static constexpr double allowance = 200, allowance_per_s = 20;

    /// Counts a request against the allowance; returns false if it is used up.
    [[nodiscard]] static bool may_ask(StreamClient& c, const StreamRequest& request, Instant now);
    void give_set_point(StreamClient& c, const boost::json::object& body, Instant now);
    void subscribe(StreamClient& c, const std::string& topic, std::int64_t period_ms);
    void unsubscribe(StreamClient& c, const std::string& topic);
    void resolve(StreamClient& c, Instant now, const std::vector<std::string>* snapshots_of);
    void begin_frames(StreamClient& c, StreamClient::FrameWatch& watch);
    [[nodiscard]] FrameDecoder& decoder_for(const std::string& line, std::uint64_t since, std::uint64_t next);
    void send_frames(StreamClient& c, StreamClient::FrameWatch& watch, Instant now);
    void send_site(StreamClient& c);
    void send_error(StreamClient& c, std::string_view text, std::string_view topic = {});
    void put_event(StreamClient& c, SharedFrame frame);
    void put_state(StreamClient& c, std::uint32_t number, SharedFrame frame);
    void wake(StreamClient& c);
    void tell_next();
    void send(StreamClient& c, std::int64_t period_ms, Instant at);
    void send_states(StreamClient& c, std::vector<StreamClient::Watch>& list, Instant at);
    [[nodiscard]] SharedFrame joined();
    void take_site(Instant now);
    void keep_groups(Instant now);
    [[nodiscard]] std::uint32_t recipe_number(const std::string& recipe);
    [[nodiscard]] std::set<std::int64_t> periods() const;
    [[nodiscard]] LineId line_id(std::string_view line) const;

    AxisPort& axes_;
    const ClockPort& clock_;
    EventPort& events_;
    const LinePort& lines_;
    SitePort& sites_;
    const Settings& settings_;
    Counters& counters_;
    std::function<void()> rearm_;
    StreamSources sources_;
    std::list<std::shared_ptr<StreamClient>> clients_;
    std::map<std::int64_t, Instant> groups_;  ///< next scan by period in ms
    struct Due {
        std::weak_ptr<StreamClient> client;
        std::int64_t period_ms;
        Instant at;          ///< of the period: all its clients get the same states
        std::size_t looked;  ///< of what it watches in that period
    };
    std::deque<Due> due_;                        ///< clients that have not been served in the present period; each client once per period
    std::shared_ptr<const SiteState> new_site_;  ///< reported, but not taken yet
    std::map<std::string, std::uint32_t, std::less<>> recipe_numbers_;  ///< of their states in the clients' queues
    std::uint32_t alarms_number_ = 0;                                   ///< of the list in the clients' queues; 0: none yet
    bool attached_ = true;

    struct KeptDecoder {
        std::unique_ptr<FrameDecoder> decoder;
        std::uint64_t next = 0;  ///< the first frame that it has not read
    };
    std::map<std::string, KeptDecoder, std::less<>> decoders_;  ///< by line of the site in force

    std::vector<SharedFrame> changed_;  ///< the messages for one client; kept for its capacity
    /// The last states that were sent together, for clients with the same subscriptions.
    struct {
        std::vector<SharedFrame> parts;
        SharedFrame all;
    } last_joined_;

    /// The last list of frames, for clients that need the same one.
    struct {
        Instant at{};
        std::string line;
        std::uint64_t since = 0, missed = 0, next = 0;
        std::size_t frames = 0;
        SharedFrame message;
    } last_frames_;
};

}  // namespace axisgate::http
