// The entities of Cyclone DDS. The configuration is built here; CYCLONEDDS_URI of the environment is ignored. No call waits longer than a
// millisecond.
#include "gateway/doors/dds/bus.hpp"

#include <dds/dds.h>
#include <dlfcn.h>
#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <memory>

namespace axisgate::dds {
namespace {
struct QosDelete {
    void operator()(dds_qos_t* q) const { dds_delete_qos(q); }
};
using Qos = std::unique_ptr<dds_qos_t, QosDelete>;

struct Shape {
    const dds_topic_descriptor_t* type;
    const char* name;
};
const Shape& shape_of(Topic t) {
    static const std::array<Shape, topic_count> shapes{Shape{&axisgate_GatewayState_desc, "axisgate_GatewayState"},
                                                       Shape{&axisgate_AxisState_desc, "axisgate_AxisState"},
                                                       Shape{&axisgate_Event_desc, "axisgate_Event"},
                                                       Shape{&axisgate_AxisCommand_desc, "axisgate_AxisCommand"},
                                                       Shape{&axisgate_CommandResult_desc, "axisgate_CommandResult"},
                                                       Shape{&axisgate_ParameterWrite_desc, "axisgate_ParameterWrite"},
                                                       Shape{&axisgate_SetPoint_desc, "axisgate_SetPoint"}};
    return shapes.at(static_cast<std::size_t>(t));
}

/// The table of docs/handbook/fleet.md. Reliable writers give up after a millisecond, so that no reader holds up the service thread.
Qos qos_of(Topic t) {
    Qos q(dds_create_qos());
    constexpr dds_duration_t patience = DDS_MSECS(1);
    const auto bounds = [&q](std::int32_t samples, std::int32_t instances, std::int32_t each) {
        dds_qset_resource_limits(q.get(), samples, instances, each);
    };
    dds_qset_writer_data_lifecycle(q.get(), true);
    switch (t) {
        case Topic::gateway_state:
        case Topic::axis_state:
            dds_qset_reliability(q.get(), DDS_RELIABILITY_RELIABLE, patience);
            dds_qset_durability(q.get(), DDS_DURABILITY_TRANSIENT_LOCAL);
            dds_qset_history(q.get(), DDS_HISTORY_KEEP_LAST, 1);
            dds_qset_deadline(q.get(), DDS_MSECS(lease_ms));
            dds_qset_liveliness(q.get(), DDS_LIVELINESS_AUTOMATIC, DDS_MSECS(lease_ms));
            dds_qset_durability_service(q.get(), 0, DDS_HISTORY_KEEP_LAST, 1, 16384, 16384, 1);
            bounds(16384, 16384, 1);
            break;
        case Topic::event:
            dds_qset_reliability(q.get(), DDS_RELIABILITY_RELIABLE, patience);
            dds_qset_durability(q.get(), DDS_DURABILITY_TRANSIENT_LOCAL);
            dds_qset_history(q.get(), DDS_HISTORY_KEEP_LAST, 256);
            dds_qset_durability_service(q.get(), 0, DDS_HISTORY_KEEP_LAST, 256, 16384, 256, 256);
            bounds(16384, 256, 256);
            break;
        case Topic::axis_command:
        case Topic::parameter_write:
            dds_qset_reliability(q.get(), DDS_RELIABILITY_RELIABLE, patience);
            dds_qset_history(q.get(), DDS_HISTORY_KEEP_ALL, 0);
            dds_qset_lifespan(q.get(), DDS_SECS(2));
            bounds(1024, 4096, 64);
            break;
        case Topic::command_result:
            dds_qset_reliability(q.get(), DDS_RELIABILITY_RELIABLE, patience);
            dds_qset_history(q.get(), DDS_HISTORY_KEEP_LAST, 64);
            bounds(65536, 16384, 64);
            break;
        case Topic::set_point:
            dds_qset_reliability(q.get(), DDS_RELIABILITY_BEST_EFFORT, 0);
            dds_qset_history(q.get(), DDS_HISTORY_KEEP_LAST, 1);
            dds_qset_ownership(q.get(), DDS_OWNERSHIP_EXCLUSIVE);
            bounds(16384, 16384, 1);
            break;
    }
    return q;
}

constexpr std::size_t most_word_bytes = 48;  // limit of one property of a participant

std::string xml_text(const std::string& s) {
    std::string out;
    for (const char c : s) {
        if (c == '&') {
            out += "&amp;";
        } else if (c == '<') {
            out += "&lt;";
        } else if (c == '"') {
            out += "&quot;";
        } else {
            out += c;
        }
    }
    return out;
}

/// On the loopback interface participants find each other by their ports, because multicast there would be visible to other machines.
std::string configuration(const BusSettings& s) {
    const bool here = s.interface_name == "lo";
    return fmt::format(
        "<Domain><General><Interfaces><NetworkInterface name=\"{}\" multicast=\"{}\"/></Interfaces><AllowMulticast>{}</AllowMulticast>"
        "</General><Discovery><ParticipantIndex>auto</ParticipantIndex><MaxAutoParticipantIndex>{}</MaxAutoParticipantIndex>"
        "<LeaseDuration>{}ms</LeaseDuration>{}</Discovery></Domain>",
        xml_text(s.interface_name), here ? "false" : "default", here ? "false" : "default", here ? 99 : 9, lease_ms,
        here ? "<Peers><Peer Address=\"127.0.0.1\"/></Peers>" : "");
}

/// The plug-ins of DDS Security are beside the library, or in a folder with its package's name.
std::string plug_in(const char* name) {
    Dl_info info{};
    if (::dladdr(reinterpret_cast<const void*>(&dds_create_participant), &info) == 0 || !info.dli_fname) return {};
    std::error_code ec;
    const auto folder = std::filesystem::canonical(info.dli_fname, ec).parent_path();
    for (const auto& place : {folder, folder / "libddsc0debian"}) {
        const auto file = place / (std::string("lib") + name + ".so");
        if (std::filesystem::exists(file, ec)) return file.string();
    }
    return {};
}

/// The participant's certificates as its properties; returns the missing file, or an empty text.
std::string secure(dds_qos_t* q, const std::string& folder) {
    struct {
        const char *property, *file;
    } const files[] = {{"dds.sec.auth.identity_ca", "identity-ca.pem"}, {"dds.sec.auth.identity_certificate", "cert.pem"},
                       {"dds.sec.auth.private_key", "key.pem"},         {"dds.sec.access.permissions_ca", "permissions-ca.pem"},
                       {"dds.sec.access.governance", "governance.p7s"}, {"dds.sec.access.permissions", "permissions.p7s"}};
    for (const auto& f : files) {
        const std::string path = folder + "/" + f.file;
        if (::access(path.c_str(), R_OK) != 0)
            return fmt::format("DDS: {}: {}; [dds] security names a folder that `axisgate pki` made, and this user must be able to read it",
                               path, std::strerror(errno));
        dds_qset_prop(q, f.property, ("file:" + path).c_str());
    }
    struct {
        const char *prefix, *library, *init, *finalize;
    } const parts[] = {{"dds.sec.auth.library", "dds_security_auth", "init_authentication", "finalize_authentication"},
                       {"dds.sec.crypto.library", "dds_security_crypto", "init_crypto", "finalize_crypto"},
                       {"dds.sec.access.library", "dds_security_ac", "init_access_control", "finalize_access_control"}};
    for (const auto& p : parts) {
        const std::string path = plug_in(p.library), prefix = p.prefix;
        if (path.empty())
            return fmt::format(
                "DDS: there is no plug-in {}: this Cyclone DDS cannot do DDS Security; install its plug-ins, or take [dds] "
                "security away",
                p.library);
        dds_qset_prop(q, (prefix + ".path").c_str(), path.c_str());
        dds_qset_prop(q, (prefix + ".init").c_str(), p.init);
        dds_qset_prop(q, (prefix + ".finalize").c_str(), p.finalize);
    }
    return {};
}

void on_data_available(dds_entity_t, void* bus) { static_cast<const Bus*>(bus)->on_data(); }
/// Called for each writer by itself: if the number of live writers has decreased, this one has ended.
void on_liveliness(dds_entity_t reader, const dds_liveliness_changed_status_t status, void* bus) {
    if (status.alive_count_change < 0) static_cast<Bus*>(bus)->on_writer_gone(reader, status.last_publication_handle);
}
bool commands_by(Topic t) { return t == Topic::axis_command || t == Topic::parameter_write; }

/// Selects the samples for this gateway. Those for others would fill the reader's places: one for each axis of the plant.
template <class T>
bool is_for(const void* sample, void* gateway) {
    return *static_cast<const std::string*>(gateway) == static_cast<const T*>(sample)->gateway;
}
dds_topic_filter_arg_fn filter_of(Topic t) {
    if (t == Topic::axis_command) return &is_for<axisgate_AxisCommand>;
    if (t == Topic::parameter_write) return &is_for<axisgate_ParameterWrite>;
    return t == Topic::set_point ? &is_for<axisgate_SetPoint> : nullptr;
}

std::string failed(const char* what, dds_return_t code) { return fmt::format("DDS: {}: {}", what, dds_strretcode(code)); }
}  // namespace

std::string Bus::open(const BusSettings& s, std::initializer_list<Topic> writes, std::initializer_list<Topic> reads) {
    close();
    gateway_ = s.gateway;
    domain_ = dds_create_domain(s.domain, configuration(s).c_str());
    if (domain_ == DDS_RETCODE_PRECONDITION_NOT_MET) domain_ = 0;  // this process has joined it already
    if (domain_ < 0) {
        const auto code = domain_;
        domain_ = 0;
        return failed(fmt::format("domain {} on the interface {} cannot be joined", s.domain, s.interface_name).c_str(), code) +
               "; check [dds] interface (`ip link` lists them)";
    }
    const Qos who(dds_create_qos());
    if (std::string fault = s.security.empty() ? std::string() : secure(who.get(), s.security); !fault.empty()) {
        close();
        return fault;
    }
    participant_ = dds_create_participant(s.domain, who.get(), nullptr);
    if (participant_ < 0) {
        const auto code = participant_;
        close();
        if (!s.security.empty())
            return failed(fmt::format("domain {} cannot be joined with the certificates in {}", s.domain, s.security).c_str(), code) +
                   "; perhaps they have expired (look at this machine's clock), or are of several authorities; `axisgate pki` makes new "
                   "ones";
        return failed(fmt::format("domain {} on the interface {} cannot be joined", s.domain, s.interface_name).c_str(), code) +
               "; check [dds] interface (`ip link` lists them), and whether too many programs of this machine are in the domain";
    }
    const Qos group(dds_create_qos());
    dds_qset_partition1(group.get(), s.partition.c_str());
    publisher_ = dds_create_publisher(participant_, group.get(), nullptr);
    subscriber_ = dds_create_subscriber(participant_, group.get(), nullptr);
    if (publisher_ < 0 || subscriber_ < 0) {
        const auto code = std::min(publisher_, subscriber_);
        close();
        return failed("a partition cannot be opened", code);
    }
    participants_ = dds_create_reader(participant_, DDS_BUILTIN_TOPIC_DCPSPARTICIPANT, nullptr, nullptr);
    for (std::size_t i = 0; i < topic_count; ++i) {
        const Topic t{static_cast<std::uint8_t>(i)};
        const auto among = [t](std::initializer_list<Topic> list) { return std::find(list.begin(), list.end(), t) != list.end(); };
        if (std::string fault = add(t, s, among(writes), among(reads)); !fault.empty()) {
            close();
            return fault;
        }
    }
    return {};
}

std::string Bus::add(Topic t, const BusSettings& s, bool writes, bool reads) {
    if (!writes && !reads) return {};
    const auto i = static_cast<std::size_t>(t);
    const Qos q = qos_of(t);
    const dds_entity_t topic = dds_create_topic(participant_, shape_of(t).type, shape_of(t).name, q.get(), nullptr);
    if (topic < 0)
        return failed(shape_of(t).name, topic) + fmt::format("; in domain {} somebody may use the name for another type", s.domain);
    if (writes) {
        writers_[i] = dds_create_writer(publisher_, topic, q.get(), nullptr);
        if (writers_[i] < 0) return failed(shape_of(t).name, writers_[i]);
    }
    if (reads) {
        // A filter applies to the whole entity of a topic, and would prevent commands to others from being written.
        dds_entity_t received = topic;
        if (filter_of(t) && !gateway_.empty()) {
            received = dds_create_topic(participant_, shape_of(t).type, shape_of(t).name, q.get(), nullptr);
            const auto set = received < 0 ? received : dds_set_topic_filter_and_arg(received, filter_of(t), &gateway_);
            if (set < 0) return failed(shape_of(t).name, set);
        }
        dds_qset_ignorelocal(q.get(), DDS_IGNORELOCAL_PARTICIPANT);
        dds_listener_t* listener = dds_create_listener(this);
        dds_lset_data_available(listener, &on_data_available);
        if (commands_by(t)) dds_lset_liveliness_changed(listener, &on_liveliness);
        const auto reader = dds_create_reader(subscriber_, received, q.get(), listener);
        dds_delete_listener(listener);
        const std::scoped_lock lock(gone_mutex_);
        readers_[i] = reader;
        if (reader < 0) return failed(shape_of(t).name, reader);
    }
    return {};
}

void Bus::close() {
    if (participant_ > 0) (void)dds_delete(participant_);  // and its dependents; no listener runs afterwards
    if (domain_ > 0) (void)dds_delete(domain_);
    domain_ = participant_ = publisher_ = subscriber_ = participants_ = 0;
    writers_.fill(0);
    readers_.fill(0);
    gone_.clear();
    gone_more_ = false;
}

bool Bus::write_raw(Topic t, const void* sample, bool ended) {
    const dds_entity_t writer = writers_[static_cast<std::size_t>(t)];
    if (writer <= 0) return false;
    return (ended ? dds_dispose(writer, sample) : dds_write(writer, sample)) == DDS_RETCODE_OK;
}

void Bus::on_writer_gone(std::int32_t reader, std::uint64_t handle) {
    {
        const std::scoped_lock lock(gone_mutex_);
        // The reader's entity is known here after its creation; a writer that came and went before has written nothing.
        const auto at = std::find(readers_.begin(), readers_.end(), reader);
        if (at == readers_.end()) return;
        gone_more_ = gone_more_ || gone_.size() >= gone_most;
        if (!gone_more_) gone_.push_back({Topic{static_cast<std::uint8_t>(at - readers_.begin())}, handle});
    }
    wake_();
}

std::vector<Bus::Writer> Bus::take_gone(const std::function<std::vector<Writer>()>& known) {
    std::unique_lock lock(gone_mutex_);
    std::vector<Writer> gone = std::exchange(gone_, {});
    const bool more = std::exchange(gone_more_, false);
    lock.unlock();
    if (!more) return gone;
    gone = known();
    std::erase_if(gone, [this](const Writer& w) { return is_there(w); });
    return gone;
}

bool Bus::is_there(const Writer& writer) const {
    const Entity reader = readers_[static_cast<std::size_t>(writer.topic)];
    dds_builtintopic_endpoint_t* data = reader > 0 ? dds_get_matched_publication_data(reader, writer.handle) : nullptr;
    if (data) dds_builtintopic_free_endpoint(data);
    return data != nullptr;
}

std::string Bus::whereabouts(const Writer& writer) const {
    const Entity reader = readers_[static_cast<std::size_t>(writer.topic)];
    dds_builtintopic_endpoint_t* data = reader > 0 ? dds_get_matched_publication_data(reader, writer.handle) : nullptr;
    if (!data) return {};
    const dds_instance_handle_t participant = data->participant_instance_handle;
    dds_builtintopic_free_endpoint(data);
    void* sample = nullptr;
    dds_sample_info_t info{};
    std::string where;
    if (participants_ <= 0 || dds_read_instance(participants_, &sample, &info, 1, 1, participant) <= 0) return where;
    if (info.valid_data) {
        const auto* const of = static_cast<const dds_builtintopic_participant_t*>(sample);
        // Properties that every participant of Cyclone DDS announces; others may announce none.
        for (const auto& [property, before] : {std::pair{"__NetworkAddresses", ""}, {"__Hostname", ""}, {"__Pid", "process "}}) {
            char* value = nullptr;
            if (!dds_qget_prop(of->qos, property, &value) || !value) continue;
            std::string_view text(value);
            // The addresses with their ports and kinds, separated by commas: "udp/192.0.2.7:7411@2".
            if (property == std::string_view("__NetworkAddresses")) text = text.substr(0, text.find(','));
            if (!text.empty()) where += fmt::format("{}{}{}", where.empty() ? "" : ", ", before, text.substr(0, most_word_bytes));
            dds_free(value);
        }
    }
    (void)dds_return_loan(participants_, &sample, 1);
    return where;
}

std::uint64_t Bus::turned_away() const {
    std::uint64_t n = 0;
    for (const Entity reader : readers_) {
        dds_sample_rejected_status_t rejected{};
        dds_sample_lost_status_t lost{};
        if (reader <= 0) continue;
        if (dds_get_sample_rejected_status(reader, &rejected) == DDS_RETCODE_OK) n += rejected.total_count;
        if (dds_get_sample_lost_status(reader, &lost) == DDS_RETCODE_OK) n += lost.total_count;
    }
    return n;
}

std::size_t Bus::take_raw(Topic t, std::size_t most, const std::function<void(const void*, const Seen&)>& each) {
    constexpr std::size_t batch = 64;
    const dds_entity_t reader = readers_[static_cast<std::size_t>(t)];
    if (reader <= 0) return 0;
    void* samples[batch] = {};
    dds_sample_info_t infos[batch];
    const auto got = dds_take(reader, samples, infos, batch, static_cast<std::uint32_t>(std::min(most, batch)));
    if (got <= 0) return 0;
    for (std::size_t i = 0; i < static_cast<std::size_t>(got); ++i)
        each(samples[i], {infos[i].valid_data, infos[i].instance_state == DDS_IST_ALIVE, infos[i].publication_handle});
    (void)dds_return_loan(reader, samples, got);
    return static_cast<std::size_t>(got);
}

}  // namespace axisgate::dds
