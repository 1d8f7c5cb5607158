// Handlers: one function per route: a call in, an answer out, now or later.
// In: the taken-apart request and the Gateway. Out: Handled. Callbacks of the Gateway keep copies only, never the Call or the Context.
// Never touches a socket, and never waits.
#pragma once

#include <boost/json/object.hpp>
#include <boost/json/value.hpp>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "gateway/doors/http/access_gate.hpp"
#include "gateway/doors/http/clients_seen.hpp"
#include "gateway/doors/http/message.hpp"
#include "gateway/doors/http/problem.hpp"
#include "gateway/doors/http/settings.hpp"
#include "gateway/doors/http/text.hpp"
#include "gateway/services/alarms/alarm.hpp"
#include "gateway/services/axis_place.hpp"
#include "gateway/services/axis_texts.hpp"
#include "gateway/services/change_queue.hpp"
#include "gateway/services/gateway.hpp"
#include "gateway/services/parameters/axis_jobs.hpp"
#include "gateway/services/services.hpp"
#include "gateway/services/site/stage_owner.hpp"

namespace axisgate::http {

/// For a change queue: 500 to whoever waits for a job that threw.
[[nodiscard]] inline ChangeQueue::Failed thrown(Respond respond) {
    return [respond = std::move(respond)](const std::string& what) {
        respond(problem(500, "internal", "a fault of the gateway itself: " + what));
    };
}

/// What all handlers share; outlives every call.
struct Context {
    Gateway& gateway;
    const Settings& settings;
    AssetLookup asset;
    std::function<std::string()> own_metrics;                                ///< the door's own counters as Prometheus text
    std::shared_ptr<ChangeQueue> changes = std::make_shared<ChangeQueue>();  ///< of the site
    std::shared_ptr<RecipeService> recipes{};                               ///< runs recipes; whoever makes a context for service gives one
    std::shared_ptr<AxisJobs> jobs = std::make_shared<AxisJobs>();          ///< many parameters of one axis, one after the other
    std::shared_ptr<AccessPort> access = nullptr;                           ///< users; without it this machine alone is let in
    std::shared_ptr<AlarmService> alarms{};                                 ///< the list of alarms; as with recipes
    std::shared_ptr<AxisTexts> axis_texts = std::make_shared<AxisTexts>();  ///< what GET /axes/{name} answers
    std::shared_ptr<StageOwner> stages = std::make_shared<StageOwner>();    ///< whose the staged site is
    std::shared_ptr<ClientsSeen> clients = std::make_shared<ClientsSeen>();       ///< to whom an axis can be handed over
    std::shared_ptr<WritesUnderWay> writes = std::make_shared<WritesUnderWay>();  ///< of parameters, each until the drive has answered
};

/// One request on its way. Lives only as long as the handler's call.
struct Call {
    const Context& context;
    const Request& request;
    const Target& target;
    std::vector<std::string> names;  ///< the path's `{...}` segments, decoded, in order
    boost::json::value body;         ///< of routes that take JSON: what was sent
    Respond respond;
    Identity identity{};

    /// Who and from where, for events and the history: as API says it; the peer alone where there are no users.
    [[nodiscard]] std::string who() const { return context.access ? axisgate::who(identity, request.peer) : request.peer; }
    [[nodiscard]] Gateway& gateway() const noexcept { return context.gateway; }
    [[nodiscard]] Origin origin() const;  ///< in handlers_authority.cpp
};

/// Who commands by such a request, `who` as Call has it. In handlers_authority.cpp.
[[nodiscard]] Origin origin_of(const Request& request, const Identity& identity, std::string who);

using Handler = Handled (*)(Call&);

// --- handlers_gateway.cpp ---------------------------------------------------------------------------------------------
Handled get_health(Call&);
Handled get_ready(Call&);
Handled get_metrics(Call&);
Handled get_description(Call&);
Handled get_about(Call&);
Handled open_stream(Call&);
// --- handlers_catalogue.cpp -------------------------------------------------------------------------------------------
Handled list_families(Call&);
Handled get_family(Call&);
Handled list_family_parameters(Call&);
Handled list_family_commands(Call&);
Handled list_family_errors(Call&);
// --- handlers_site.cpp ------------------------------------------------------------------------------------------------
Handled list_lines(Call&);
Handled list_drives(Call&);
Handled list_axes(Call&);
Handled get_line(Call&);
Handled get_drive(Call&);
Handled get_axis(Call&);
Handled add_line(Call&);
Handled add_drive(Call&);
Handled add_axis(Call&);
Handled replace_line(Call&);
Handled replace_drive(Call&);
Handled replace_axis(Call&);
Handled change_line(Call&);
Handled change_drive(Call&);
Handled change_axis(Call&);
Handled remove_line(Call&);
Handled remove_drive(Call&);
Handled remove_axis(Call&);
Handled get_site(Call&);
Handled replace_site(Call&);
// --- handlers_mappings.cpp --------------------------------------------------------------------------------------------
Handled list_mappings(Call&);
Handled get_mapping(Call&);
Handled add_mapping(Call&);
Handled replace_mapping(Call&);
Handled remove_mapping(Call&);
Handled remove_mappings(Call&);
Handled list_mapping_units(Call&);
Handled change_mapping_unit(Call&);
Handled get_mappings_csv(Call&);
Handled replace_mappings_csv(Call&);
Handled add_mappings_csv(Call&);
Handled list_mapping_points(Call&);
// --- handlers_commands.cpp --------------------------------------------------------------------------------------------
Handled command_axis(Call&);
Handled act_on_axis(Call&);
Handled start_moves(Call&);
// --- handlers_modbus.cpp ----------------------------------------------------------------------------------------------
Handled get_modbus_door(Call&);
Handled change_modbus_door(Call&);
// --- handlers_authority.cpp -------------------------------------------------------------------------------------------
Handled list_authority(Call&);
Handled get_authority(Call&);
Handled take_authority(Call&);
/// Gives up what this user, or this user's token ("anna line3"), holds: he may not command any more. `by`: who did that.
void end_leases_of(Gateway& gateway, std::string_view client, const std::string& by);
Handled release_authority(Call&);
Handled hand_over_authority(Call&);
// --- handlers_parameters.cpp ------------------------------------------------------------------------------------------
Handled list_parameters(Call&);
Handled read_parameter(Call&);
Handled write_parameter(Call&);
// --- handlers_drives.cpp ----------------------------------------------------------------------------------------------
Handled exchange_native(Call&);
Handled get_hand(Call&);
Handled set_hand(Call&);
// --- handlers_records.cpp ---------------------------------------------------------------------------------------------
Handled get_trace(Call&);
Handled list_events(Call&);

// --- handlers_alarms.cpp ----------------------------------------------------------------------------------------------
Handled list_alarms(Call&);
Handled acknowledge_alarm(Call&);
Handled acknowledge_alarms(Call&);
Handled shelve_alarm(Call&);
Handled unshelve_alarm(Call&);
// --- handlers_scan.cpp ------------------------------------------------------------------------------------------------
Handled start_scan(Call&);
Handled get_scan(Call&);
Handled cancel_scan(Call&);
// --- handlers_recipes.cpp ---------------------------------------------------------------------------------------------
Handled list_recipes(Call&);
Handled get_recipe(Call&);
Handled put_recipe(Call&);
Handled remove_recipe(Call&);
Handled run_recipe(Call&);
Handled list_recipe_runs(Call&);
Handled get_recipe_run(Call&);
Handled cancel_recipe_run(Call&);
// --- handlers_snapshots.cpp -------------------------------------------------------------------------------------------
Handled list_snapshots(Call&);
Handled take_snapshot(Call&);
Handled get_snapshot_progress(Call&);
Handled get_snapshot(Call&);
Handled remove_snapshot(Call&);
Handled diff_snapshot(Call&);
Handled restore_snapshot(Call&);
// --- handlers_parameter_table.cpp -------------------------------------------------------------------------------------
Handled get_parameter_history(Call&);
Handled get_parameters_csv(Call&);
Handled put_parameters_csv(Call&);
// --- handlers_stage.cpp -----------------------------------------------------------------------------------------------
Handled stage_site(Call&);
Handled get_stage(Call&);
Handled discard_stage(Call&);
Handled apply_stage(Call&);
Handled confirm_stage(Call&);
Handled roll_back_stage(Call&);
Handled list_site_history(Call&);
Handled get_site_revision(Call&);
Handled restore_site_revision(Call&);
Handled get_backup(Call&);
Handled put_backup(Call&);
Handled get_waiting_backup(Call&);
Handled cancel_waiting_backup(Call&);
// --- handlers_registers.cpp -------------------------------------------------------------------------------------------
Handled get_registers(Call&);
Handled get_mapping_list(Call&);
Handled get_next_free(Call&);
Handled add_mapping_template(Call&);
// --- handlers_session.cpp ---------------------------------------------------------------------------------------------
Handled get_session(Call&);
Handled sign_in(Call&);
Handled sign_out(Call&);
Handled first_sign_in(Call&);
// --- handlers_users.cpp -----------------------------------------------------------------------------------------------
Handled list_users(Call&);
Handled add_user(Call&);
Handled get_user(Call&);
Handled change_user(Call&);
Handled remove_user(Call&);
Handled change_password(Call&);
// --- handlers_tokens.cpp ----------------------------------------------------------------------------------------------
Handled list_tokens(Call&);
Handled add_token(Call&);
Handled remove_token(Call&);

// --- shared -----------------------------------------------------------------------------------------------------------

/// 404 that names what there is none of: "there is no axis slide".
[[nodiscard]] Response nothing_named(std::string_view what, std::string_view name);
/// 400 for a query parameter that is wrong.
[[nodiscard]] Response bad_query(std::string_view name, std::string_view must);
/// A flag of the query; false if it is not given. On nothing: `fault` holds the answer.
[[nodiscard]] bool query_flag(const Call& call, std::string_view name, std::optional<Response>& fault);
/// A whole number of the query.
[[nodiscard]] std::int64_t query_whole(const Call& call, std::string_view name, std::int64_t low, std::int64_t high, std::int64_t otherwise,
                                       std::optional<Response>& fault);

/// Body of a 200 to a command.
[[nodiscard]] boost::json::object command_answer(Ticket ticket, std::string_view result, std::string_view reason, std::string_view axis,
                                                 std::string_view command);
/// Hands a command to the gateway; a good result goes through `show`, another becomes a problem. `wait_s` > 0: until it is done, or for
/// that long, whichever is sooner.
[[nodiscard]] Handled submit_command(Call& call, Command command, std::string axis, std::string name, double wait_s,
                                     std::function<Response(const Result&)> show);
/// The result of a command as a 200.
[[nodiscard]] Response answer_of(const Result& result, std::string_view axis, std::string_view command);
/// Writes checked values one after the other (handlers_snapshots.cpp); `more`: further members of the answer.
[[nodiscard]] Handled write_parameters(Call& call, const AxisPlace& axis, std::vector<JobPoint> points, boost::json::object more);
/// What is written back only if it is asked for by name.
struct WriteBack {
    bool addressing = false;  ///< include_addressing
    bool live = false;        ///< include_live
};
/// Why a parameter of the catalogue's `addressing` or `live` is left out when many are written back; empty: it is not.
[[nodiscard]] std::string why_left_out(const Parameter& parameter, WriteBack wanted);
/// `?state=` of alarms; nothing if it is not given (handlers_alarms.cpp).
[[nodiscard]] std::optional<AlarmFilter> query_alarm_state(const Call& call, std::optional<Response>& fault);
/// `?wait=`: 0 if it is not given.
[[nodiscard]] double query_wait(const Call& call, std::optional<Response>& fault);

/// Longest time that a handler waits for the gateway when the client gave none: a result must come, this is for when it does not.
inline constexpr std::chrono::seconds gateway_limit{30};
/// The hot thread did not say how the Modbus door stands.
[[nodiscard]] inline Response late_modbus() {
    return problem(504, "no_answer", "the Modbus door did not say in time; come again in a moment");
}

}  // namespace axisgate::http
