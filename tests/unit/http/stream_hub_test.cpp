// The live feed without sockets in virtual time: snapshots, changes at most once per period, slow readers, and messages that are never
// dropped.
#include "gateway/doors/http/stream_hub.hpp"

#include <gtest/gtest.h>

#include <boost/json/serialize.hpp>

#include "gateway/doors/http/websocket_codec.hpp"
#include "gateway/doors/http/words.hpp"
#include "tests/unit/http/fake_gateway.hpp"

namespace axisgate::http::test {
namespace {
namespace json = boost::json;
using std::chrono::milliseconds;

TEST(StreamQueue, NewestStateWinsInThePlaceOfTheOlder) {
    const auto frame = [](const char* s) { return std::make_shared<const std::string>(s); };
    StreamQueue q(2);
    EXPECT_FALSE(q.push_state(1, frame("a1")));
    EXPECT_TRUE(q.push_event(frame("e1")));
    EXPECT_FALSE(q.push_state(2, frame("b1")));
    EXPECT_TRUE(q.push_state(1, frame("a2"))) << "it replaced one";
    EXPECT_TRUE(q.push_event(frame("e2")));
    EXPECT_FALSE(q.push_event(frame("e3"))) << "over the bound: refused, not dropped";
    q.push_control(frame("pong"));
    std::string all;
    for (const auto& f : q.take(1000))
        all += *f + " ";
    EXPECT_EQ(all, "pong a2 e1 b1 e2 ");
    EXPECT_TRUE(q.empty());
    EXPECT_TRUE(q.push_event(frame("e4"))) << "room again";
}

TEST(StreamQueue, BatchesAreBounded) {
    StreamQueue q(10);
    for (int i = 0; i < 5; ++i)
        ASSERT_TRUE(q.push_event(std::make_shared<const std::string>(40, 'x')));
    EXPECT_EQ(q.take(100).size(), 2u);
    EXPECT_EQ(q.take(1).size(), 1u) << "at least one";
    EXPECT_EQ(q.events_waiting(), 2u);
    q.clear();
    EXPECT_TRUE(q.empty());
    for (int i = 0; i < 100; ++i)
        q.push_control(std::make_shared<const std::string>(std::to_string(i)));
    const auto control = q.take(1000);
    EXPECT_EQ(control.size(), 16u);
    EXPECT_EQ(*control.back(), "99") << "a flood of pings is answered by its newest";
}

TEST(StreamRequest, ReadsAndRefuses) {
    std::string fault;
    const auto r = read_stream_request(R"({"subscribe":["axes/*","events"],"unsubscribe":["x"],"period_ms":51})", fault);
    ASSERT_TRUE(r);
    EXPECT_EQ(r->subscribe.size(), 2u);
    EXPECT_EQ(r->unsubscribe.size(), 1u);
    EXPECT_EQ(r->period_ms, 60) << "rounded up, so that clients share their scans";
    EXPECT_EQ(read_stream_request(R"({"subscribe":[]})", fault)->period_ms, 100);
    for (const auto* bad :
         {"", "{", "[]", "5", R"({"subscribe":"axes/*"})", R"({"subscribe":[1]})", R"({"period_ms":50})",
          R"({"subscribe":[],"period_ms":9})", R"({"subscribe":[],"period_ms":10001})", R"({"subscribe":[],"period_ms":"50"})",
          R"({"subscribe":[],"period_ms":10.5})", R"({"subscribe":[],"what":1})"}) {
        fault.clear();
        EXPECT_FALSE(read_stream_request(bad, fault)) << bad;
        EXPECT_FALSE(fault.empty()) << bad;
    }
    EXPECT_FALSE(read_stream_request(R"({"subscribe":["events"],"subscribe":["axes/*"]})", fault));
    EXPECT_EQ(fault, "the member \"subscribe\" stands twice (/subscribe): keep one of them");
}

struct Message {
    std::string topic;
    json::value data;
    std::int64_t at = 0;
};

class StreamHubTest : public ::testing::Test {
protected:
    FakeGateway gateway;
    Settings settings;
    Counters counters;
    int rearmed = 0, woken = 0;
    StreamHub hub{gateway, settings, counters, [this] { ++rearmed; }};
    std::shared_ptr<StreamClient> client = hub.add([this] { ++woken; });
    Instant now = at_ns(1'000'000'000);

    /// The waiting messages of the client, in order; control frames as topics "close 1013 reason".
    static std::vector<Message> taken(StreamClient& c) {
        std::vector<Message> out;
        for (const auto& f : c.queue.take(SIZE_MAX)) {
            const auto first = static_cast<std::uint8_t>(f->at(0));
            std::size_t at = 2, n = static_cast<std::uint8_t>(f->at(1));
            if (n >= 126) {
                const std::size_t bytes = n == 126 ? 2 : 8;
                n = 0;
                for (std::size_t i = 0; i < bytes; ++i)
                    n = n << 8 | static_cast<std::uint8_t>(f->at(2 + i));
                at += bytes;
            }
            EXPECT_EQ(f->size(), at + n);
            const std::string payload = f->substr(at);
            if (first == 0x88) {
                out.push_back(
                    {"close " + std::to_string(static_cast<std::uint8_t>(payload.at(0)) * 256 + static_cast<std::uint8_t>(payload.at(1))) +
                         " " + payload.substr(2),
                     {},
                     0});
                continue;
            }
            EXPECT_EQ(first, 0x81);
            const auto v = json::parse(payload).get_object();
            out.push_back({std::string(v.at("topic").get_string()), v.at("data"), v.at("at").to_number<std::int64_t>()});
        }
        return out;
    }
    std::vector<Message> taken() { return taken(*client); }
    static std::string topics(const std::vector<Message>& list) {
        std::string s;
        for (const auto& m : list)
            s += (s.empty() ? "" : " ") + m.topic;
        return s;
    }
    void say(std::string_view text) { hub.on_text(*client, text, now); }
    void pass(std::int64_t ms) {
        const Instant end = now + milliseconds(ms);
        while (hub.deadline() <= end) {
            now = std::max(now, hub.deadline());
            hub.on_deadline(now);
        }
        now = end;
    }
};

TEST_F(StreamHubTest, SnapshotThenOnlyChangesAtMostOncePerPeriod) {
    gateway.set_picture("feeder", standing(3200));
    gateway.set_picture("slide", standing(7));
    say(R"({"subscribe":["axes/*"],"period_ms":50})");
    auto first = taken();
    EXPECT_EQ(topics(first), "axes/feeder axes/slide");
    EXPECT_EQ(first[0].at, gateway.now_ns);
    EXPECT_EQ(first[0].data.at("position").to_number<double>(), 1.0);
    EXPECT_EQ(first[0].data.at("name"), "feeder");
    EXPECT_TRUE(first[0].data.get_object().contains("age_ms")) << "of the moment `at`";
    EXPECT_GE(rearmed, 1);
    EXPECT_EQ(hub.deadline(), now + milliseconds(50));

    pass(1000);
    EXPECT_TRUE(taken().empty()) << "nothing changed";
    for (int i = 0; i < 100; ++i) {  // every ms another position
        gateway.set_picture("slide", standing(100 + i));
        pass(1);
    }
    const auto changes = taken();
    ASSERT_EQ(changes.size(), 1u) << "taken late: only the newest waited";
    EXPECT_EQ(changes[0].topic, "axes/slide");
    EXPECT_EQ(counters.stream_states_replaced, 1u);
    int messages = 0;
    for (int i = 0; i < 200; ++i) {
        gateway.set_picture("slide", standing(1000 + i));
        pass(1);
        messages += static_cast<int>(taken().size());
    }
    EXPECT_EQ(messages, 4) << "200 changes in 200 ms at a period of 50 ms";
}

TEST_F(StreamHubTest, TimeAloneIsToldOncePerSecond) {
    gateway.set_picture("slide", standing(7, 0));
    say(R"({"subscribe":["axes/slide"],"period_ms":10})");
    taken();
    int messages = 0;
    for (int i = 1; i <= 300; ++i) {
        gateway.set_picture("slide", standing(7, i * 10));
        pass(10);
        messages += static_cast<int>(taken().size());
    }
    EXPECT_GE(messages, 2);
    EXPECT_LE(messages, 3) << "3 s in which only the instant of the data moved on";
}

TEST_F(StreamHubTest, OneSerialisationServesAllClients) {
    std::vector<std::shared_ptr<StreamClient>> many;
    for (int i = 0; i < 50; ++i) {
        many.push_back(hub.add({}));
        hub.on_text(*many.back(), R"({"subscribe":["axes/*"],"period_ms":50})", now);
        taken(*many.back());
    }
    gateway.set_picture("slide", standing(9));
    gateway.pictures_read = 0;
    pass(50);
    EXPECT_EQ(gateway.pictures_read, 1) << "one changed axis, read once";
    const auto a = many[0]->queue.take(SIZE_MAX), b = many[49]->queue.take(SIZE_MAX);
    ASSERT_EQ(a.size(), 1u);
    ASSERT_EQ(b.size(), 1u);
    EXPECT_EQ(a[0].get(), b[0].get()) << "the same frame, not a copy";
}

TEST_F(StreamHubTest, OneClientIsToldAtATimeAndAllTheSame) {
    gateway.set_picture("slide", standing(1));
    std::vector<std::shared_ptr<StreamClient>> many;
    for (int i = 0; i < 10; ++i) {
        many.push_back(hub.add({}));
        hub.on_text(*many.back(), R"({"subscribe":["axes/*"],"period_ms":50})", now);
        taken(*many.back());
    }
    gateway.set_picture("slide", standing(2));
    const auto published = [&] { return std::ranges::count_if(many, [](const auto& c) { return !c->queue.empty(); }); };
    now += milliseconds(50);
    hub.on_deadline(now);
    EXPECT_EQ(published(), 1) << "then others have their turn";
    EXPECT_EQ(hub.deadline(), time_zero) << "the rest at once";
    gateway.set_picture("slide", standing(3));  // while the messages of the period are being made
    for (int i = 2; i <= 9; ++i) {
        hub.on_deadline(now + milliseconds(1));
        EXPECT_EQ(published(), i);
    }
    many[9]->close(close_policy, "gone meanwhile");
    hub.remove(many[9]);
    hub.on_deadline(now + milliseconds(2));
    EXPECT_EQ(hub.deadline(), now + milliseconds(50));
    const auto first = many[0]->queue.take(SIZE_MAX), last = many[8]->queue.take(SIZE_MAX);
    ASSERT_EQ(first.size(), 1u);
    ASSERT_EQ(last.size(), 1u);
    EXPECT_EQ(first[0].get(), last[0].get()) << "of one period everybody is told the same";
}

TEST_F(StreamHubTest, StatesAreMadeAFewAtATime) {
    boost::json::array lines{json::object{{"name", "can0"}, {"uri", "twin"}, {"family", "demo"}}}, drives, axes;
    constexpr int many = 8;
    for (int i = 1; i <= many; ++i) {
        const std::string name = "a" + std::to_string(i);
        drives.push_back({{"name", name}, {"line", "can0"}, {"address", 4 + i}});
        axes.push_back({{"name", name}, {"drive", name}, {"number", i}});
    }
    gateway.put_site(json::serialize(json::object{{"lines", lines}, {"drives", drives}, {"axes", axes}}));
    for (int i = 1; i <= many; ++i)
        gateway.set_picture("a" + std::to_string(i), standing(1));
    say(R"({"subscribe":["axes/*"],"period_ms":50})");
    taken();
    for (int i = 1; i <= many; ++i)
        gateway.set_picture("a" + std::to_string(i), standing(2));
    now += milliseconds(50);
    int turns = 0;
    do {
        EXPECT_TRUE(client->queue.empty()) << "told as one, when all are made";
        hub.on_deadline(now);
        ++turns;
    } while (hub.deadline() == time_zero && turns < 100);
    EXPECT_EQ(turns, 3) << "three, three, the last two and the client";
    EXPECT_EQ(taken().size(), static_cast<std::size_t>(many));
}

TEST_F(StreamHubTest, APeriodThatIsNotToldToAllYetDoesNotBeginAnew) {
    gateway.set_picture("slide", standing(1));
    std::vector<std::shared_ptr<StreamClient>> many;
    for (int i = 0; i < 2; ++i) {
        many.push_back(hub.add({}));
        hub.on_text(*many.back(), R"({"subscribe":["axes/*"],"period_ms":50})", now);
        taken(*many.back());
    }
    int seen = 2;
    for (int i = 0; i < 2; ++i) {  // so slow that the next period begins before the last clients were served
        gateway.set_picture("slide", standing(seen++));
        now += milliseconds(50);
        hub.on_deadline(now);
    }
    for (const auto& c : many)
        EXPECT_EQ(taken(*c).size(), 1u) << "each once";
    pass(49);
    for (const auto& c : many)
        EXPECT_TRUE(c->queue.empty()) << "the period that was left out is not made up for";
}

TEST_F(StreamHubTest, WhoIsSentToAtOnceSharesOneRunOfBytes) {
    const auto two = [&](int position) {
        gateway.set_picture("feeder", standing(position));
        gateway.set_picture("slide", standing(position));
    };
    two(0);
    const auto slow = hub.add({}), one = hub.add({}), other = hub.add({});
    one->takes_at_once = other->takes_at_once = true;
    for (const auto& c : {slow, one, other}) {
        hub.on_text(*c, R"({"subscribe":["axes/*"],"period_ms":50})", now);
        taken(*c);
    }
    two(1);
    pass(50);
    const auto a = one->queue.take(SIZE_MAX), b = other->queue.take(SIZE_MAX), each = slow->queue.take(SIZE_MAX);
    ASSERT_EQ(a.size(), 1u);
    ASSERT_EQ(b.size(), 1u);
    ASSERT_EQ(each.size(), 2u) << "who is still being sent to keeps each state by itself, so that a newer one can take its place";
    EXPECT_EQ(a[0].get(), b[0].get());
    EXPECT_EQ(*a[0], *each[0] + *each[1]) << "the same frames";
    EXPECT_EQ(counters.stream_frames_sent, 2u) << "all but the one that who sends counts";
    hub.on_text(*one, R"({"subscribe":["events"]})", now);
    gateway.tell(event("waits"));
    two(2);
    pass(50);
    EXPECT_EQ(topics(taken(*one)), "events axes/feeder axes/slide") << "behind what waits, each by itself";
}

TEST_F(StreamHubTest, DifferentPeriodsOfOneClient) {
    gateway.set_picture("feeder", standing(0));
    gateway.set_picture("slide", standing(0));
    say(R"({"subscribe":["axes/*"],"period_ms":1000})");
    say(R"({"subscribe":["axes/slide"],"period_ms":10})");
    EXPECT_EQ(topics(taken()), "axes/feeder axes/slide") << "the second snapshot of slide took the place of the first, unread one";
    gateway.set_picture("feeder", standing(1));
    gateway.set_picture("slide", standing(1));
    pass(20);
    EXPECT_EQ(topics(taken()), "axes/slide") << "the name is closer than the star";
    pass(1000);
    EXPECT_EQ(topics(taken()), "axes/feeder");
}

TEST_F(StreamHubTest, ResubscribingGivesASnapshotAgain) {
    gateway.set_picture("slide", standing(1));
    say(R"({"subscribe":["axes/slide"]})");
    taken();
    say(R"({"subscribe":["axes/slide"]})");
    EXPECT_EQ(topics(taken()), "axes/slide");
    say(R"({"subscribe":["events"]})");
    EXPECT_EQ(topics(taken()), "") << "others get none";
}

TEST_F(StreamHubTest, WhoSubscribesWithoutEndIsClosed) {
    int taken_requests = 0;
    for (; client->closing() == 0 && taken_requests < 10'000; ++taken_requests) {
        say(R"({"subscribe":["axes/slide"]})");
        if (client->closing() == 0) taken();
    }
    EXPECT_GT(taken_requests, 150) << "a page that is drawn anew may ask often";
    EXPECT_LT(taken_requests, 250);
    EXPECT_EQ(client->closing(), close_policy);
    EXPECT_EQ(topics(taken()).substr(0, 10), "close 1008");
    // Small changes without an end; frames of lines, with a long past, cost more.
    auto calm = hub.add({});
    for (int i = 0; i < 2000; ++i, now += milliseconds(100))
        hub.on_text(*calm, R"({"subscribe":["axes/slide"]})", now), (void)taken(*calm);
    EXPECT_EQ(calm->closing(), 0);
    auto frames = hub.add({});
    int asked = 0;
    for (; frames->closing() == 0 && asked < 10'000; ++asked) {
        hub.on_text(*frames, R"({"subscribe":["lines/can0/frames"]})", now);
        if (frames->closing() == 0) (void)taken(*frames);
    }
    EXPECT_LT(asked, 60);
}

TEST_F(StreamHubTest, Unsubscribing) {
    say(R"({"subscribe":["axes/*","events","site","lines/can0/frames"]})");
    taken();
    say(R"({"unsubscribe":["axes/*","events","site","lines/can0/frames"]})");
    EXPECT_EQ(taken().size(), 0u);
    gateway.set_picture("slide", standing(2));
    gateway.tell(event("x"));
    EXPECT_EQ(hub.deadline(), never);
    pass(500);
    EXPECT_TRUE(taken().empty());
    say(R"({"unsubscribe":["axes/*"]})");
    const auto error = taken();
    ASSERT_EQ(error.size(), 1u);
    EXPECT_EQ(error[0].topic, "error");
    EXPECT_EQ(error[0].data.at("topic"), "axes/*");
}

TEST_F(StreamHubTest, UnknownTopicsAreToldOneByOneAndTheRestHolds) {
    gateway.set_picture("slide", standing(2));
    say(R"({"subscribe":["axes/none","axes/slide","what","lines/none/frames","lines//frames","lines/frames","axes/","*"]})");
    const auto got = taken();
    EXPECT_EQ(topics(got), "error error error error error error error axes/slide");
    EXPECT_EQ(got[0].data.at("topic"), "axes/none");
    EXPECT_EQ(counters.stream_requests_wrong, 7u);
}

TEST_F(StreamHubTest, EventsAreNeverDroppedOverTheBoundTheClientIsClosed) {
    settings.max_events_waiting = 3;
    auto slow = hub.add({});
    hub.on_text(*slow, R"({"subscribe":["events"]})", now);
    say(R"({"subscribe":["events"]})");
    for (int i = 0; i < 3; ++i)
        gateway.tell(event("n" + std::to_string(i), "slide", Severity::alarm, "alarm"));
    EXPECT_EQ(slow->closing(), 0);
    EXPECT_EQ(taken().size(), 3u);
    gateway.tell(event("one more"));
    EXPECT_EQ(slow->closing(), close_try_later);
    const auto last = taken(*slow);
    ASSERT_EQ(last.size(), 1u) << "nothing but the close frame";
    EXPECT_EQ(last[0].topic.substr(0, 10), "close 1013");
    EXPECT_NE(last[0].topic.find("events"), std::string::npos) << "with a reason: " << last[0].topic;
    const auto other = taken();
    ASSERT_EQ(other.size(), 1u) << "the fast client is not touched";
    EXPECT_EQ(other[0].data.at("text"), "one more");
    EXPECT_EQ(other[0].data.at("id").to_number<int>(), 4);
    gateway.tell(event("later"));
    EXPECT_TRUE(taken(*slow).empty());
}

TEST_F(StreamHubTest, ThreeWrongMessagesInARowCloseTheClient) {
    say("nonsense");
    say("{}");
    EXPECT_EQ(topics(taken()), "error error");
    say(R"({"subscribe":["site"]})");
    say("nonsense");
    say("nonsense");
    EXPECT_EQ(client->closing(), 0) << "a good one in between begins anew";
    say("nonsense");
    EXPECT_EQ(client->closing(), close_unsupported);
    EXPECT_EQ(topics(taken()).substr(0, 10), "close 1003");
}

TEST_F(StreamHubTest, SiteChanges) {
    gateway.set_picture("feeder", standing(1));
    gateway.set_picture("slide", standing(1));
    say(R"({"subscribe":["axes/*","site","drives/slide","lines/can0/frames"],"period_ms":50})");
    EXPECT_EQ(topics(taken()), "site lines/can0/frames axes/feeder axes/slide drives/slide");
    const int before = rearmed;
    gateway.put_site(
        R"({"lines":[{"name":"can0","uri":"twin","family":"demo"}],"drives":[{"name":"feeder","line":"can0","address":5},{"name":"new","line":"can0","address":9}],
                         "axes":[{"name":"feeder","drive":"feeder","number":1,"unit":"deg","increments_per_unit":10},{"name":"new","drive":"new","number":3}],"mappings":[]})");
    EXPECT_GT(rearmed, before);
    EXPECT_EQ(hub.deadline(), time_zero) << "due at once";
    hub.on_deadline(now);
    auto got = taken();
    EXPECT_EQ(topics(got), "axes/slide drives/slide axes/new site") << "gone ones as null, new ones with a snapshot";
    EXPECT_TRUE(got[0].data.is_null());
    EXPECT_TRUE(got[1].data.is_null());
    EXPECT_EQ(got[3].data.at("revision").to_number<int>(), 2);
    pass(50);
    got = taken();
    EXPECT_EQ(topics(got), "axes/feeder") << "its unit is another";
    EXPECT_EQ(got[0].data.at("unit"), "deg");
    gateway.set_picture("new", standing(5));
    pass(50);
    EXPECT_EQ(topics(taken()), "axes/new");
}

TEST_F(StreamHubTest, DrivesAndLinesAreLookedAtFourTimesASecondAtMost) {
    say(R"({"subscribe":["drives/*","lines/can0"],"period_ms":10})");
    EXPECT_EQ(topics(taken()), "drives/bare drives/feeder drives/slide lines/can0");
    int messages = 0;
    for (int i = 0; i < 100; ++i) {
        gateway.line_states[gateway.line("can0")].status.frames_in = static_cast<std::uint64_t>(i);
        pass(10);
        messages += static_cast<int>(taken().size());
    }
    EXPECT_GE(messages, 3);
    EXPECT_LE(messages, 4);
    gateway.drive_states[gateway.drive("slide")] = {Presence::twin, true, false, "the device does not answer", 4, 200};
    pass(300);
    const auto got = taken();
    ASSERT_FALSE(got.empty());
    EXPECT_EQ(got[0].topic, "drives/slide");
    EXPECT_EQ(got[0].data.at("status").at("presence"), "twin");
}

TraceEntry entry(std::uint64_t sequence) {
    TraceEntry e;
    e.sequence = sequence;
    e.at_unix_ns = 1'000'000'000;
    const std::uint8_t data[] = {0x01};
    e.frame = Frame::can_extended(0x04280095, data);
    return e;
}

TEST_F(StreamHubTest, FramesComeInListsWithACountOfTheMissed) {
    auto& trace = gateway.traces[gateway.line("can0")];
    for (std::uint64_t i = 1; i <= 300; ++i)
        trace.push_back(entry(i));
    say(R"({"subscribe":["lines/can0/frames"],"period_ms":50})");
    auto got = taken();
    ASSERT_EQ(topics(got), "lines/can0/frames");
    EXPECT_EQ(got[0].data.at("frames").get_array().size(), 200u) << "the newest ones at once";
    EXPECT_EQ(got[0].data.at("frames").get_array()[0].at("sequence").to_number<int>(), 101);
    EXPECT_EQ(got[0].data.at("missed").to_number<int>(), 0);
    pass(500);
    EXPECT_TRUE(taken().empty()) << "no frames, no message";
    for (std::uint64_t i = 301; i <= 303; ++i)
        trace.push_back(entry(i));
    pass(50);
    got = taken();
    ASSERT_EQ(got.size(), 1u);
    EXPECT_EQ(got[0].data.at("frames").get_array().size(), 3u);
    EXPECT_EQ(got[0].data.at("frames").get_array()[0].at("decoded").get_array()[0], "from the drive, frame 201 of 1 bytes")
        << "the reader goes on where it was";

    // The client does not read: one list waits, the position in the recording is kept, and overwritten frames are counted.
    trace.push_back(entry(304));
    pass(50);
    trace.clear();
    for (std::uint64_t i = 400; i <= 401; ++i)
        trace.push_back(entry(i));
    pass(200);
    got = taken();
    ASSERT_EQ(got.size(), 1u);
    EXPECT_EQ(got[0].data.at("frames").get_array().size(), 1u);
    EXPECT_EQ(got[0].data.at("missed").to_number<int>(), 0);
    pass(50);
    got = taken();
    ASSERT_EQ(got.size(), 1u);
    EXPECT_EQ(got[0].data.at("missed").to_number<int>(), 95) << "305 to 399";
    EXPECT_EQ(got[0].data.at("frames").get_array().size(), 2u);
    EXPECT_EQ(got[0].data.at("frames").get_array()[0].at("text"), "04280095#01");
    EXPECT_EQ(got[0].data.at("frames").get_array()[0].at("decoded").get_array()[0], "from the drive, frame 1 of 1 bytes")
        << "after a gap the reader begins anew";
}

TEST_F(StreamHubTest, ALateScanDoesNotMakeUpForPeriods) {
    gateway.set_picture("slide", standing(1));
    say(R"({"subscribe":["axes/slide"],"period_ms":10})");
    now += milliseconds(1005);
    hub.on_deadline(now);
    EXPECT_EQ(hub.deadline(), now + milliseconds(10));
}

TEST_F(StreamHubTest, RemovedClientsCostNothing) {
    say(R"({"subscribe":["axes/*","events"],"period_ms":50})");
    EXPECT_EQ(counters.stream_clients, 1u);
    hub.remove(client);
    EXPECT_EQ(counters.stream_clients, 0u);
    EXPECT_EQ(hub.deadline(), never);
    gateway.tell(event("x"));
}

/// The subscriptions of the page's overview and of a plot of an axis: 30 clients that read nothing while the axes move.
TEST_F(StreamHubTest, ThirtyPlotsThatAreNotReadHoldTheNewestOfEachTopicAndNoMore) {
    std::vector<std::shared_ptr<StreamClient>> plots;
    const auto open = [&](StreamClient& c) {
        hub.on_text(c, R"({"subscribe":["axes/*"],"period_ms":100})", now);
        hub.on_text(c, R"({"subscribe":["drives/*","lines/*"],"period_ms":500})", now);
        hub.on_text(c, R"({"subscribe":["events","alarms"],"period_ms":1000})", now);
        hub.on_text(c, R"({"subscribe":["axes/slide"],"period_ms":20})", now);
    };
    for (int i = 0; i < 30; ++i) {
        plots.push_back(hub.add({}));
        open(*plots.back());
    }
    open(*client);
    const auto bytes_of = [](StreamClient& c) {
        std::size_t bytes = 0;
        for (const auto& f : c.queue.take(SIZE_MAX))
            bytes += f->size();
        return bytes;
    };
    pass(1000);
    const std::size_t whole = bytes_of(*client);  // each topic once
    for (const auto& plot : plots)
        (void)taken(*plot);
    for (std::int64_t i = 1; i <= 3000; ++i) {  // a minute
        gateway.set_picture("slide", standing(i));
        gateway.set_picture("feeder", standing(-i));
        pass(20);
        (void)taken();
    }
    EXPECT_GE(counters.stream_states_replaced, 29u * 3000u) << "what is not read gives its place to the newer one";
    for (const auto& plot : plots) {
        EXPECT_EQ(plot->closing(), 0) << "who is slow and loses no event stays";
        EXPECT_EQ(plot->queue.events_waiting(), 0u);
        if (plot != plots[0]) {
            EXPECT_LE(bytes_of(*plot), 2 * whole) << "each topic once, with longer figures";
            continue;
        }
        std::map<std::string, int> waiting;
        for (const auto& m : taken(*plot)) {
            ++waiting[m.topic];
            if (m.topic == "axes/slide") EXPECT_EQ(m.data.at("position_increments").to_number<int>(), 3000) << "the newest";
        }
        EXPECT_GE(waiting.size(), 2u);
        for (const auto& [topic, n] : waiting)
            EXPECT_EQ(n, 1) << topic;
    }
    for (const auto& plot : plots)
        hub.remove(plot);
    EXPECT_EQ(hub.clients(), 1u);
}

TEST_F(StreamHubTest, TopicsPerClientAreBounded) {
    // 1024 axes can exist; here the bound is reached with few topics.
    for (int i = 0; i < 10; ++i)
        say(R"({"subscribe":["axes/slide","axes/feeder","events","site"]})");
    taken();
    std::string many = R"({"subscribe":[)";
    for (int i = 0; i < 1101; ++i)
        many += (i ? ",\"axes/*\"" : "\"axes/*\"");
    say(many + "]}");
    EXPECT_EQ(topics(taken()), "error") << "too many topics in one request";
}

TEST(StreamHub, StopsListeningWhenItEnds) {
    FakeGateway gateway;
    Settings settings;
    Counters counters;
    {
        StreamHub hub(gateway, settings, counters, {});
        EXPECT_EQ(gateway.listeners.size(), 1u);
        hub.detach();
        EXPECT_EQ(gateway.listeners.size(), 0u);
    }
    EXPECT_EQ(gateway.listeners.size(), 0u);
}

TEST_F(StreamHubTest, ASetPointIsHandedOnWithoutAnAnswer) {
    client->commander = [] {
        return Origin{axisgate::http::clients, std::make_shared<const std::string>("anna 10.0.0.7:4711"),
                      std::make_shared<const std::string>("anna")};
    };
    say(R"({"set_point":{"axis":"feeder","mode":"position","value":12.5,"velocity":2,"good_for_ms":100}})");
    say(R"({"set_point":{"axis":"slide","mode":"velocity","value":-7}})");
    ASSERT_EQ(gateway.set_points.size(), 2u);
    const SetPoint& p = gateway.set_points[0];
    EXPECT_EQ(p.axis, gateway.axis("feeder"));
    EXPECT_EQ(p.mode, SetPoint::Mode::position);
    EXPECT_EQ(p.value, 40000);
    EXPECT_EQ(p.velocity, 6400);
    EXPECT_FALSE(p.acceleration);
    EXPECT_EQ(p.good_for, milliseconds(100));
    EXPECT_EQ(p.at, now) << "when the message was here";
    EXPECT_EQ(*p.origin.client, "anna");
    EXPECT_EQ(gateway.set_points[1].value, -7);
    EXPECT_EQ(gateway.set_points[1].good_for, milliseconds(500));
    EXPECT_TRUE(taken(*client).empty());
    EXPECT_EQ(hub.deadline(), never) << "nobody watches anything";
}

TEST_F(StreamHubTest, AFeedThatClosesEndsItsStreamUnlessItsClientGivesSetPointsElsewhere) {
    const auto anna = [] {
        return Origin{axisgate::http::clients, std::make_shared<const std::string>("anna 10.0.0.7:4711"),
                      std::make_shared<const std::string>("anna")};
    };
    const auto other = hub.add({});
    client->commander = other->commander = anna;
    hub.remove(hub.add({}));
    EXPECT_TRUE(gateway.lost.empty()) << "it has given none";
    say(R"({"set_point":{"axis":"feeder","mode":"position","value":1}})");
    hub.on_text(*other, R"({"set_point":{"axis":"slide","mode":"velocity","value":1}})", now);
    hub.remove(other);
    EXPECT_TRUE(gateway.lost.empty()) << "the same client streams by the first feed";
    hub.remove(client);
    ASSERT_EQ(gateway.lost.size(), 1u);
    EXPECT_EQ(gateway.lost[0].first.name, "anna");
    EXPECT_EQ(gateway.lost[0].second, LossCause::set_points_silent);
}

TEST_F(StreamHubTest, ASetPointThatCannotBeHandedOnIsToldWithTheReason) {
    const auto published = [&](std::string_view text) {
        say(text);
        const auto messages = taken(*client);
        EXPECT_EQ(messages.size(), 1u) << text;
        return messages.empty() ? std::string() : messages[0].topic + " " + json::serialize(messages[0].data);
    };
    EXPECT_NE(published(R"({"set_point":{"axis":"feeder","mode":"position","value":1}})").find("operator"), std::string::npos);
    client->commander = [] { return std::optional<Origin>(); };
    EXPECT_NE(published(R"({"set_point":{"axis":"feeder","mode":"position","value":1}})").find("operator"), std::string::npos);
    client->commander = [] { return Origin{axisgate::http::clients, {}, {}}; };
    EXPECT_NE(published(R"({"set_point":{"axis":"nobody","mode":"position","value":1}})").find("no axis nobody"), std::string::npos);
    EXPECT_NE(published(R"({"set_point":{"mode":"position","value":1}})").find("axis"), std::string::npos);
    EXPECT_NE(published(R"({"set_point":{"axis":"feeder","mode":"place","value":1}})").find("torque"), std::string::npos);
    EXPECT_NE(published(R"({"set_point":{"axis":"feeder","mode":"position"}})").find("needs value"), std::string::npos);
    EXPECT_NE(published(R"({"set_point":{"axis":"feeder","mode":"position","value":1,"good_for_ms":19}})").find("20..10000"),
              std::string::npos);
    EXPECT_NE(published(R"({"set_point":{"axis":"feeder","mode":"position","value":1,"speed":2}})").find("speed"), std::string::npos);
    EXPECT_NE(published(R"({"set_point":5})").find("object"), std::string::npos);
    EXPECT_TRUE(gateway.set_points.empty());
}

TEST_F(StreamHubTest, AThousandSetPointsASecondAreNotTooMany) {
    client->commander = [] { return Origin{axisgate::http::clients, {}, {}}; };
    for (int i = 0; i < 20'000; ++i) {
        now += milliseconds(1);
        say(R"({"set_point":{"axis":"slide","mode":"position","value":1}})");
    }
    EXPECT_EQ(client->closing(), 0);
    EXPECT_EQ(gateway.set_points.size(), 20'000u);
    for (int i = 0; i < 20'000; ++i)
        say(R"({"set_point":{"axis":"slide","mode":"position","value":1}})");
    EXPECT_EQ(client->closing(), 1008) << "a flood is";
    EXPECT_LT(gateway.set_points.size(), 30'100u);
}
}  // namespace
}  // namespace axisgate::http::test
