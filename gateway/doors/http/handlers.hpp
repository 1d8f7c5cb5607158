// One function per route: a call in, an answer out, now or later. Each takes, beside the call, the ports that it uses, by their types.
// Callbacks of ports keep copies and ports only, never the Call or the Context. Handlers never wait and use no socket.
#pragma once

#include <boost/json/object.hpp>
#include <boost/json/value.hpp>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "gateway/doors/http/access_gate.hpp"
#include "gateway/doors/http/message.hpp"
#include "gateway/doors/http/problem.hpp"
#include "gateway/doors/http/settings.hpp"
#include "gateway/doors/http/text.hpp"
#include "gateway/services/access/authority_view.hpp"
#include "gateway/services/access/clients_seen.hpp"
#include "gateway/services/alarms/alarm.hpp"
#include "gateway/services/axis_place.hpp"
#include "gateway/services/axis_texts.hpp"
#include "gateway/services/change_queue.hpp"
#include "gateway/services/descriptions/description_files.hpp"
#include "gateway/services/fail_safe/fail_safe_matrix.hpp"
#include "gateway/services/parameters/axis_jobs.hpp"
#include "gateway/services/parameters/drive_comparisons.hpp"
#include "gateway/services/parameters/snapshots.hpp"
#include "gateway/services/ports.hpp"
#include "gateway/services/recipes/recipe_documents.hpp"
#include "gateway/services/recipes/recipe_steps.hpp"
#include "gateway/services/services.hpp"
#include "gateway/services/site/site_entries.hpp"
#include "gateway/services/site/site_staging.hpp"
#include "gateway/services/site/stage_owner.hpp"

namespace axisgate::http {

/// For a change queue: answers 500 if the job threw.
[[nodiscard]] inline ChangeQueue::Failed thrown(Respond respond) {
    return [respond = std::move(respond)](const std::string& what) {
        respond(problem(500, "internal", "a fault of the gateway itself: " + what));
    };
}

/// The common data of all handlers; outlives every call.
struct Context {
    Ports ports;  ///< not used by handlers directly: take<> gives each its own
    const Settings& settings;
    AssetLookup asset;
    std::function<std::string()> own_metrics;                                     ///< the door's own counters as Prometheus text
    std::shared_ptr<ChangeQueue> changes = std::make_shared<ChangeQueue>();       ///< of the site
    std::shared_ptr<RecipeService> recipes{};                                     ///< runs recipes; must be set for the service
    std::shared_ptr<AxisJobs> jobs = std::make_shared<AxisJobs>();                ///< many parameters of one axis, one after the other
    std::shared_ptr<AccessPort> access = nullptr;                                 ///< users; without it only requests from this machine are
                                                                                  ///< accepted
    std::shared_ptr<AlarmService> alarms{};                                       ///< the list of alarms; must be set for the service
    std::shared_ptr<Rehearsals> rehearsals{};                                     ///< of loss of command; must be set for the service
    std::shared_ptr<RecipeRehearsals> recipe_rehearsals{};                        ///< against specimens; must be set for the service
    std::shared_ptr<AxisTexts> axis_texts = std::make_shared<AxisTexts>();        ///< the answers of GET /axes/{name}
    std::shared_ptr<StageOwner> stages = std::make_shared<StageOwner>();          ///< the owner of the staged site
    std::shared_ptr<ClientsSeen> clients = std::make_shared<ClientsSeen>();       ///< the candidates for a hand-over
    std::shared_ptr<WritesUnderWay> writes = std::make_shared<WritesUnderWay>();  ///< of parameters, each until the drive has answered
    /// Runs the pieces of a long answer, each in its turn with other requests. Default: at once.
    std::function<void(std::function<void()>)> later = [](const std::function<void()>& piece) { piece(); };
    std::function<Instant()> now = [] { return Instant{std::chrono::steady_clock::now().time_since_epoch()}; };
};

/// One request in progress. Lives only as long as the handler's call.
struct Call {
    const Context& context;
    const Request& request;
    const Target& target;
    std::vector<std::string> names;  ///< the path's `{...}` segments, decoded, in order
    boost::json::value body;         ///< of routes that take JSON: the body
    Respond respond;
    Identity identity{};

    /// The client and its address, for events and the history; without users only the peer.
    [[nodiscard]] std::string who() const { return context.access ? axisgate::who(identity, request.peer) : request.peer; }
    [[nodiscard]] Origin origin() const;  ///< in handlers_authority.cpp
};

/// The client of such a request; `who` as in Call. In handlers_authority.cpp.
[[nodiscard]] Origin origin_of(const Request& request, const Identity& identity, std::string who);

using Handler = Handled (*)(Call&);

/// One parameter of a handler: a port, a set of some, or a service that is made of ports and shared data.
template <class Part>
struct Picked {
    static Part from(const Context& context) { return context.ports.get<std::remove_cvref_t<Part>>(); }
};
template <class... Port>
struct Picked<const PortSet<Port...>&> {
    static PortSet<Port...> from(const Context& context) { return context.ports; }
};
template <>
struct Picked<const Snapshots&> {
    static Snapshots from(const Context& context) { return {context.ports, context.jobs}; }
};
template <>
struct Picked<const DriveComparisons&> {
    static DriveComparisons from(const Context& context) { return {context.ports, context.jobs}; }
};
template <>
struct Picked<const SiteStaging&> {
    static SiteStaging from(const Context& context) { return {context.ports, context.stages}; }
};
template <>
struct Picked<const DescriptionFiles&> {
    static DescriptionFiles from(const Context& context) { return {context.ports, context.changes}; }
};
template <>
struct Picked<const RecipeDocuments&> {
    static RecipeDocuments from(const Context& context) { return {context.ports, context.recipes}; }
};
template <class... Parts>
Handled call_with_ports(Handled (*handler)(Call&, Parts...), Call& call) {
    return handler(call, Picked<Parts>::from(call.context)...);
}
/// A function with its ports, as the router calls it.
template <auto handler>
Handled take(Call& call) {
    return call_with_ports(handler, call);
}

// --- handlers_gateway.cpp ---------------------------------------------------------------------------------------------
Handled get_health(Call&, const StatusPort&);
Handled get_ready(Call&, const StatusPort&);
Handled get_metrics(Call&, const StatusPort&);
Handled get_description(Call&);
Handled get_eds(Call&, const SitePort&, const StatusPort&);
Handled get_about(Call&, const ClockPort&, const SitePort&, const StatusPort&);
Handled open_stream(Call&);
// --- handlers_catalogue.cpp -------------------------------------------------------------------------------------------
Handled list_families(Call&, const SitePort&);
Handled get_family(Call&, const SitePort&);
Handled get_specimen(Call&, const SitePort&);
Handled list_family_parameters(Call&, const SitePort&);
Handled list_family_commands(Call&, const SitePort&);
Handled list_family_errors(Call&, const SitePort&);
// --- handlers_site.cpp ------------------------------------------------------------------------------------------------
Handled list_lines(Call&, const EntryPorts&);
Handled list_drives(Call&, const EntryPorts&);
Handled list_axes(Call&, const EntryPorts&);
Handled get_line(Call&, const EntryPorts&);
Handled get_drive(Call&, const EntryPorts&);
Handled get_axis(Call&, const EntryPorts&);
Handled add_line(Call&, const EntryPorts&, const StagePort&);
Handled add_drive(Call&, const EntryPorts&, const StagePort&);
Handled add_axis(Call&, const EntryPorts&, const StagePort&);
Handled replace_line(Call&, const EntryPorts&, const StagePort&);
Handled replace_drive(Call&, const EntryPorts&, const StagePort&);
Handled replace_axis(Call&, const EntryPorts&, const StagePort&);
Handled change_line(Call&, const EntryPorts&, const StagePort&);
Handled change_drive(Call&, const EntryPorts&, const StagePort&);
Handled change_axis(Call&, const EntryPorts&, const StagePort&);
Handled remove_line(Call&, SitePort&, const StagePort&);
Handled remove_drive(Call&, SitePort&, const StagePort&);
Handled remove_axis(Call&, SitePort&, const StagePort&);
Handled get_site(Call&, const SitePort&);
Handled replace_site(Call&, SitePort&, const StagePort&);
// --- handlers_mappings.cpp --------------------------------------------------------------------------------------------
Handled list_mappings(Call&, const SitePort&);
Handled get_mapping(Call&, const SitePort&);
Handled add_mapping(Call&, SitePort&, const StagePort&);
Handled replace_mapping(Call&, SitePort&, const StagePort&);
Handled remove_mapping(Call&, SitePort&, const StagePort&);
Handled remove_mappings(Call&, SitePort&, const StagePort&);
Handled list_mapping_units(Call&, const SitePort&);
Handled change_mapping_unit(Call&, SitePort&, const StagePort&);
Handled get_fleet(Call&, const FleetPort&);
Handled command_fleet_axis(Call&, FleetPort&);
Handled list_assemblies(Call&, const SitePort&);
Handled get_assembly(Call&, const SitePort&);
Handled put_assembly(Call&, SitePort&, const StagePort&);
Handled remove_assembly(Call&, SitePort&, const StagePort&);
Handled get_assemblies_csv(Call&, const SitePort&);
Handled replace_assemblies_csv(Call&, SitePort&, const StagePort&);
Handled add_assemblies_csv(Call&, SitePort&, const StagePort&);
Handled list_profiles(Call&, const SitePort&);
Handled get_profile(Call&, const SitePort&);
Handled put_profile(Call&, SitePort&, const StagePort&);
Handled remove_profile(Call&, SitePort&, const StagePort&);
Handled get_mappings_csv(Call&, const SitePort&);
Handled replace_mappings_csv(Call&, SitePort&, const StagePort&);
Handled add_mappings_csv(Call&, SitePort&, const StagePort&);
Handled list_mapping_points(Call&);
// --- handlers_commands.cpp --------------------------------------------------------------------------------------------
Handled command_axis(Call&, AxisPort&, const SitePort&);
Handled act_on_axis(Call&, AxisPort&, const SitePort&);
Handled start_moves(Call&, AxisPort&, const SitePort&);
// --- handlers_modbus.cpp ----------------------------------------------------------------------------------------------
Handled get_modbus_door(Call&, ModbusPort&);
Handled change_modbus_door(Call&, ModbusPort&);
// --- handlers_connections.cpp -----------------------------------------------------------------------------------------
Handled list_connections(Call&, ConnectionPort&);
Handled close_connection(Call&, ConnectionPort&);
// --- handlers_authority.cpp -------------------------------------------------------------------------------------------
Handled list_authority(Call&, const AxisPort&, const ClockPort&, ModbusPort&, const SitePort&);
Handled get_authority(Call&, const AxisPort&, const ClockPort&, ModbusPort&, const SitePort&);
Handled take_authority(Call&, AxisPort&, const ClockPort&, const SitePort&);
Handled release_authority(Call&, AxisPort&, const ClockPort&, const SitePort&);
Handled hand_over_authority(Call&, AxisPort&, const ClockPort&, const SitePort&);
// --- handlers_parameters.cpp ------------------------------------------------------------------------------------------
Handled list_parameters(Call&, const ParameterPort&, const SitePort&);
Handled read_parameter(Call&, AxisPort&, const ClockPort&, const ParameterPort&, const SitePort&);
Handled write_parameter(Call&, AxisPort&, const ParameterPort&, const SitePort&);
// --- handlers_drives.cpp ----------------------------------------------------------------------------------------------
Handled exchange_native(Call&, AxisPort&, const ClockPort&, const SitePort&);
Handled get_hand(Call&, DrivePort&, const SitePort&);
Handled set_hand(Call&, DrivePort&, const SitePort&);
// --- handlers_records.cpp ---------------------------------------------------------------------------------------------
Handled get_trace(Call&, const LinePort&, const SitePort&);
Handled list_events(Call&, EventPort&);

// --- handlers_fail_safe.cpp -------------------------------------------------------------------------------------------
Handled get_fail_safe(Call&, const MatrixPorts&);
Handled get_axis_fail_safe(Call&, const MatrixPorts&);
Handled put_axis_fail_safe(Call&, const MatrixPorts&, const StagePort&);
Handled get_rehearsal(Call&);
Handled start_rehearsal(Call&);
// --- handlers_alarms.cpp ----------------------------------------------------------------------------------------------
Handled list_alarms(Call&);
Handled acknowledge_alarm(Call&);
Handled acknowledge_alarms(Call&);
Handled shelve_alarm(Call&);
Handled unshelve_alarm(Call&);
// --- handlers_scan.cpp ------------------------------------------------------------------------------------------------
Handled start_scan(Call&, LinePort&, const SitePort&);
Handled get_scan(Call&, LinePort&, const SitePort&);
Handled list_host_ports(Call&, const LinePort&, const SitePort&);
Handled cancel_scan(Call&, LinePort&, const SitePort&);
// --- handlers_descriptions.cpp ----------------------------------------------------------------------------------------
Handled list_descriptions(Call&, const DescriptionFiles&);
Handled get_drive_description(Call&, const DescriptionFiles&);
Handled get_description_objects(Call&, const DescriptionFiles&);
Handled add_description(Call&, const DescriptionFiles&);
Handled remove_description(Call&, const DescriptionFiles&);
// --- handlers_recorder.cpp --------------------------------------------------------------------------------------------
Handled get_trends(Call&, const ClockPort&, RecorderPort&, const SitePort&);
Handled get_recorded_steps(Call&, const ClockPort&, RecorderPort&, const SitePort&);
Handled list_recordings(Call&, const ClockPort&, RecorderPort&);
Handled make_recording(Call&, EventPort&, RecorderPort&);
Handled get_recording(Call&, RecorderPort&);
Handled play_back_recording(Call&, RecorderPort&);
Handled rename_recording(Call&, RecorderPort&);
Handled remove_recording(Call&, RecorderPort&);
/// The refusal of a request for a capture or a recording (`kind`) of that name.
[[nodiscard]] Response kept_refusal(std::string_view kind, const RecordingFault& fault, std::string_view name);
// --- handlers_captures.cpp --------------------------------------------------------------------------------------------
Handled list_captures(Call&, CapturePort&);
Handled arm_capture(Call&, CapturePort&, EventPort&, const SitePort&);
Handled get_capture(Call&, CapturePort&);
Handled rename_capture(Call&, CapturePort&);
Handled remove_capture(Call&, CapturePort&);
// --- handlers_recipes.cpp ---------------------------------------------------------------------------------------------
Handled list_recipes(Call&, const RecipeDocuments&);
Handled get_recipe(Call&, const RecipeDocuments&);
Handled put_recipe(Call&, const RecipeDocuments&);
Handled remove_recipe(Call&, const RecipeDocuments&);
Handled run_recipe(Call&, const RecipeDocuments&);
Handled list_recipe_runs(Call&, const RecipeDocuments&);
Handled get_recipe_run(Call&);
Handled cancel_recipe_run(Call&);
Handled get_recipe_rehearsal(Call&, const RecipeDocuments&);
Handled rehearse_recipe(Call&, const RecipeDocuments&);
Handled cancel_recipe_rehearsal(Call&, const RecipeDocuments&);
// --- handlers_snapshots.cpp -------------------------------------------------------------------------------------------
Handled list_snapshots(Call&, const Snapshots&);
Handled take_snapshot(Call&, const SitePort&, const Snapshots&);
Handled get_snapshot_progress(Call&, const SitePort&);
Handled get_snapshot(Call&, const Snapshots&);
Handled remove_snapshot(Call&, const Snapshots&);
Handled diff_snapshot(Call&, const Snapshots&);
Handled restore_snapshot(Call&, const Snapshots&);
// --- handlers_comparison.cpp ------------------------------------------------------------------------------------------
Handled compare_with_twin(Call&, const DriveComparisons&);
Handled get_comparison(Call&, const DriveComparisons&);
Handled adopt_comparison(Call&, const DriveComparisons&);
// --- handlers_parameter_table.cpp -------------------------------------------------------------------------------------
Handled get_parameter_history(Call&, const ParameterPort&, const SitePort&);
Handled get_parameters_csv(Call&, const ParameterPort&, const SitePort&);
Handled put_parameters_csv(Call&, AxisPort&, const ParameterPort&, const SitePort&);
// --- handlers_stage.cpp -----------------------------------------------------------------------------------------------
Handled stage_site(Call&, const SitePort&, const SiteStaging&);
Handled get_stage(Call&, const SitePort&, const SiteStaging&);
Handled discard_stage(Call&, const SiteStaging&);
Handled apply_stage(Call&, const SitePort&, const SiteStaging&);
Handled confirm_stage(Call&, const SitePort&, const SiteStaging&);
Handled roll_back_stage(Call&, const SitePort&, const SiteStaging&);
Handled list_site_history(Call&, const SitePort&);
Handled get_site_revision(Call&, const SitePort&);
Handled restore_site_revision(Call&, const SitePort&, const SiteStaging&);
Handled get_backup(Call&, BackupPort&, EventPort&);
Handled put_backup(Call&, BackupPort&);
Handled get_waiting_backup(Call&, BackupPort&);
Handled cancel_waiting_backup(Call&, BackupPort&);
// --- handlers_registers.cpp -------------------------------------------------------------------------------------------
Handled get_registers(Call&, RegisterPort&, const SitePort&);
Handled get_mapping_list(Call&, const SitePort&);
Handled get_next_free(Call&, const SitePort&);
Handled add_mapping_template(Call&, SitePort&, const StagePort&);
// --- handlers_session.cpp ---------------------------------------------------------------------------------------------
Handled get_session(Call&);
Handled sign_in(Call&, const ClockPort&);
Handled sign_out(Call&);
Handled first_sign_in(Call&, const ClockPort&);
// --- handlers_users.cpp -----------------------------------------------------------------------------------------------
Handled list_users(Call&);
Handled add_user(Call&, const ClockPort&);
Handled get_user(Call&);
Handled change_user(Call&, AxisPort&, const SitePort&);
Handled remove_user(Call&, AxisPort&, const SitePort&);
Handled change_password(Call&, const ClockPort&);
// --- handlers_tokens.cpp ----------------------------------------------------------------------------------------------
Handled list_tokens(Call&);
Handled add_token(Call&, const ClockPort&);
Handled remove_token(Call&, AxisPort&, const SitePort&);

// --- shared -----------------------------------------------------------------------------------------------------------

/// The answer for a service's result, or the problem for its refusal.
template <class T, class Show>
[[nodiscard]] Response given(const Refusable<T>& answer, Show&& show) {
    const auto* refusal = std::get_if<ServiceRefusal>(&answer);
    return refusal ? problem_of(*refusal) : show(std::get<T>(answer));
}
/// 200 with the document, for given().
inline constexpr auto json_answer = [](const auto& document) { return json_response(document); };
/// 204.
[[nodiscard]] Response nothing_left();
/// 200 with a file under this name.
[[nodiscard]] Response file_answer(std::string_view media, std::string_view name, std::string text);
/// For content that is JSON or a text: by ?format=json or `other`, otherwise by Accept. On a fault (400, 406) `fault` has the answer.
[[nodiscard]] bool wants_json(const Call& call, std::string_view other, std::optional<Response>& fault);
/// A job on an axis' parameters has begun: its answer, or 202 with the place of its progress if it takes longer.
[[nodiscard]] Handled job_later(const std::string& axis);
/// The answer after many parameters were written.
[[nodiscard]] std::function<void(const Refusable<WrittenParameters>&)> show_written(Respond respond);

/// 404 with the missing name: "there is no axis slide".
[[nodiscard]] Response nothing_named(std::string_view what, std::string_view name);
/// 400 for a wrong query parameter.
[[nodiscard]] Response bad_query(std::string_view name, std::string_view must);
/// A flag of the query; false if it is absent. If empty, `fault` has the answer.
[[nodiscard]] bool query_flag(const Call& call, std::string_view name, std::optional<Response>& fault);
/// A whole number of the query.
[[nodiscard]] std::int64_t query_whole(const Call& call, std::string_view name, std::int64_t low, std::int64_t high, std::int64_t otherwise,
                                       std::optional<Response>& fault);

/// Body of a 200 to a command.
[[nodiscard]] boost::json::object command_answer(Ticket ticket, std::string_view result, std::string_view reason, std::string_view axis,
                                                 std::string_view command);
/// Gives a command to the gateway; a good result goes through `show`, another becomes a problem. `wait_s` > 0: until it is done, or for
/// that time.
[[nodiscard]] Handled submit_command(Call& call, AxisPort& axes, Command command, std::string axis, std::string name, double wait_s,
                                     std::function<Response(const Result&)> show);
/// The result of a command as a 200.
[[nodiscard]] Response answer_of(const Result& result, std::string_view axis, std::string_view command);
/// `?state=` of alarms; empty if it is absent (handlers_alarms.cpp).
[[nodiscard]] std::optional<AlarmFilter> query_alarm_state(const Call& call, std::optional<Response>& fault);
/// `?wait=`: 0 if it is absent.
[[nodiscard]] double query_wait(const Call& call, std::optional<Response>& fault);

/// Longest time that a handler waits for the gateway without a time of the client: a result always comes, and this is for the case that it
/// does not.
inline constexpr std::chrono::seconds gateway_limit{30};
/// The hot thread did not report the state of the Modbus door.
[[nodiscard]] inline Response late_modbus() {
    return problem(504, "no_answer", "the Modbus door did not say in time; come again in a moment");
}

}  // namespace axisgate::http
