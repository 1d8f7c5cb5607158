// Every path of this door with its method, role, input and output, and the event of a good answer. Tests compare it with
// schema/openapi.yaml.
#include "gateway/doors/http/router.hpp"

#include <array>

namespace axisgate::http {
namespace {
using Takes = Route::Takes;
using Gives = Route::Gives;

constexpr std::array routes{
    Route{"/healthz", Method::get, take<get_health>}.needs(Role::none),
    Route{"/readyz", Method::get, take<get_ready>}.needs(Role::none),
    Route{"/metrics", Method::get, take<get_metrics>, Takes::nothing, Gives::text},
    Route{"/api/v1/openapi.yaml", Method::get, take<get_description>, Takes::nothing, Gives::yaml}.needs(Role::none),
    Route{"/api/v1/about", Method::get, take<get_about>},
    Route{"/api/v1/families", Method::get, take<list_families>},
    Route{"/api/v1/families/{family}", Method::get, take<get_family>},
    Route{"/api/v1/families/{family}/specimens/{specimen}", Method::get, take<get_specimen>},
    Route{"/api/v1/families/{family}/parameters", Method::get, take<list_family_parameters>},
    Route{"/api/v1/families/{family}/commands", Method::get, take<list_family_commands>},
    Route{"/api/v1/families/{family}/errors", Method::get, take<list_family_errors>},
    Route{"/api/v1/lines", Method::get, take<list_lines>},
    Route{"/api/v1/lines", Method::post, take<add_line>, Takes::json},
    Route{"/api/v1/lines/{line}", Method::get, take<get_line>},
    Route{"/api/v1/lines/{line}", Method::put, take<replace_line>, Takes::json},
    Route{"/api/v1/lines/{line}", Method::patch, take<change_line>, Takes::patch},
    Route{"/api/v1/lines/{line}", Method::remove, take<remove_line>, Takes::nothing, Gives::nothing}.asks("cascade"),
    Route{"/api/v1/lines/{line}/trace", Method::get, take<get_trace>, Takes::nothing, Gives::own}.asks("format since limit"),
    Route{"/api/v1/lines/{line}/scan", Method::get, take<get_scan>},
    Route{"/api/v1/lines/{line}/scan", Method::post, take<start_scan>, Takes::json},
    Route{"/api/v1/lines/{line}/scan", Method::remove, take<cancel_scan>}.leaves("scan", "the search for drives on line {} is ended"),
    Route{"/api/v1/host/ports", Method::get, take<list_host_ports>}.needs(Role::engineer),
    Route{"/api/v1/drives", Method::get, take<list_drives>},
    Route{"/api/v1/drives", Method::post, take<add_drive>, Takes::json},
    Route{"/api/v1/drives/{drive}", Method::get, take<get_drive>},
    Route{"/api/v1/drives/{drive}", Method::put, take<replace_drive>, Takes::json},
    Route{"/api/v1/drives/{drive}", Method::patch, take<change_drive>, Takes::patch},
    Route{"/api/v1/drives/{drive}", Method::remove, take<remove_drive>, Takes::nothing, Gives::nothing}.asks("cascade"),
    Route{"/api/v1/drives/{drive}/native", Method::post, take<exchange_native>, Takes::json},
    Route{"/api/v1/drives/{drive}/hand", Method::get, take<get_hand>}.asks("describe"),
    Route{"/api/v1/drives/{drive}/hand", Method::put, take<set_hand>, Takes::json},
    Route{"/api/v1/drives/{drive}/hand", Method::patch, take<set_hand>, Takes::patch},
    Route{"/api/v1/axes", Method::get, take<list_axes>},
    Route{"/api/v1/axes", Method::post, take<add_axis>, Takes::json},
    Route{"/api/v1/axes/{axis}", Method::get, take<get_axis>},
    Route{"/api/v1/axes/{axis}", Method::put, take<replace_axis>, Takes::json},
    Route{"/api/v1/axes/{axis}", Method::patch, take<change_axis>, Takes::patch},
    Route{"/api/v1/axes/{axis}", Method::remove, take<remove_axis>, Takes::nothing, Gives::nothing}.asks("cascade"),
    Route{"/api/v1/axes/{axis}/commands", Method::post, take<command_axis>, Takes::json}
        .asks("wait")
        .needs(Role::viewer)
        .moves(),  // stops; all others: operator
    Route{"/api/v1/axes/{axis}/actions", Method::post, take<act_on_axis>, Takes::json}.asks("wait").moves(),
    Route{"/api/v1/authority", Method::get, take<list_authority>},
    Route{"/api/v1/axes/{axis}/authority", Method::get, take<get_authority>},
    Route{"/api/v1/axes/{axis}/authority", Method::put, take<take_authority>, Takes::json}.needs(Role::operating),
    Route{"/api/v1/axes/{axis}/authority", Method::remove, take<release_authority>, Takes::nothing, Gives::nothing}.needs(Role::operating),
    Route{"/api/v1/axes/{axis}/authority/hand-over", Method::post, take<hand_over_authority>, Takes::json}.needs(Role::operating),
    Route{"/api/v1/modbus", Method::get, take<get_modbus_door>},
    Route{"/api/v1/modbus", Method::patch, take<change_modbus_door>, Takes::patch},
    Route{"/api/v1/connections", Method::get, take<list_connections>},
    Route{"/api/v1/connections/{connection}", Method::remove, take<close_connection>, Takes::nothing, Gives::nothing},
    Route{"/api/v1/axes/{axis}/parameters", Method::get, take<list_parameters>}.asks("group array first"),
    Route{"/api/v1/axes/{axis}/parameters/{parameter}", Method::get, take<read_parameter>}.asks("cached history"),
    Route{"/api/v1/axes/{axis}/parameters/{parameter}", Method::put, take<write_parameter>, Takes::json},
    Route{"/api/v1/moves/start", Method::post, take<start_moves>, Takes::json}.asks("wait").needs(Role::operating).moves(),
    Route{"/api/v1/site", Method::get, take<get_site>},
    Route{"/api/v1/site", Method::put, take<replace_site>, Takes::json}.asks("dry_run"),
    Route{"/api/v1/mappings", Method::get, take<list_mappings>}.asks("unit axis"),
    Route{"/api/v1/mappings", Method::post, take<add_mapping>, Takes::json},
    Route{"/api/v1/mappings", Method::remove, take<remove_mappings>}.asks("unit axis ids all dry_run"),
    Route{"/api/v1/mappings.csv", Method::get, take<get_mappings_csv>, Takes::nothing, Gives::own},
    Route{"/api/v1/mappings.csv", Method::post, take<add_mappings_csv>, Takes::csv}.asks("dry_run"),
    Route{"/api/v1/mappings.csv", Method::put, take<replace_mappings_csv>, Takes::csv}.asks("dry_run"),
    Route{"/api/v1/mapping-points", Method::get, take<list_mapping_points>},
    Route{"/api/v1/mappings/{mapping}", Method::get, take<get_mapping>},
    Route{"/api/v1/mappings/{mapping}", Method::put, take<replace_mapping>, Takes::json},
    Route{"/api/v1/mappings/{mapping}", Method::remove, take<remove_mapping>, Takes::nothing, Gives::nothing},
    Route{"/api/v1/axes/{axis}/comparison", Method::get, take<get_comparison>},
    Route{"/api/v1/axes/{axis}/comparison", Method::post, take<compare_with_twin>},
    Route{"/api/v1/axes/{axis}/comparison/adopt", Method::post, take<adopt_comparison>},
    Route{"/api/v1/axes/{axis}/snapshots", Method::get, take<list_snapshots>},
    Route{"/api/v1/axes/{axis}/snapshots", Method::post, take<take_snapshot>, Takes::json},
    Route{"/api/v1/axes/{axis}/snapshot-progress", Method::get, take<get_snapshot_progress>},
    Route{"/api/v1/axes/{axis}/snapshots/{snapshot}", Method::get, take<get_snapshot>, Takes::nothing, Gives::own}.asks("format"),
    Route{"/api/v1/axes/{axis}/snapshots/{snapshot}", Method::remove, take<remove_snapshot>, Takes::nothing, Gives::nothing},
    Route{"/api/v1/axes/{axis}/snapshots/{snapshot}/diff", Method::get, take<diff_snapshot>}.asks("with"),
    Route{"/api/v1/axes/{axis}/snapshots/{snapshot}/restore", Method::post, take<restore_snapshot>, Takes::json},
    Route{"/api/v1/axes/{axis}/parameters/{parameter}/history", Method::get, take<get_parameter_history>}.asks("limit"),
    Route{"/api/v1/axes/{axis}/parameters.csv", Method::get, take<get_parameters_csv>, Takes::nothing, Gives::own},
    Route{"/api/v1/axes/{axis}/parameters.csv", Method::put, take<put_parameters_csv>, Takes::csv}.asks(
        "dry_run include_addressing include_live"),
    Route{"/api/v1/site/stage", Method::get, take<get_stage>},
    Route{"/api/v1/site/stage", Method::post, take<stage_site>, Takes::json}.asks("replace").leaves("site", "a site was staged"),
    Route{"/api/v1/site/stage", Method::remove, take<discard_stage>, Takes::nothing, Gives::nothing}.leaves(
        "site", "the staged site was discarded"),
    Route{"/api/v1/site/stage/apply", Method::post, take<apply_stage>, Takes::json},
    Route{"/api/v1/site/stage/confirm", Method::post, take<confirm_stage>},
    Route{"/api/v1/site/stage/roll-back", Method::post, take<roll_back_stage>},
    Route{"/api/v1/site/history", Method::get, take<list_site_history>}.asks("limit before"),
    Route{"/api/v1/site/history/{revision}", Method::get, take<get_site_revision>},
    Route{"/api/v1/site/history/{revision}/restore", Method::post, take<restore_site_revision>}.asks("replace").leaves(
        "site", "revision {} of the site was staged"),
    Route{"/api/v1/backup", Method::get, take<get_backup>, Takes::nothing, Gives::own}.needs(Role::administrator),
    Route{"/api/v1/backup", Method::put, take<put_backup>, Takes::bytes}.needs(Role::administrator),
    Route{"/api/v1/backup/pending", Method::get, take<get_waiting_backup>}.needs(Role::administrator),
    Route{"/api/v1/backup/pending", Method::remove, take<cancel_waiting_backup>, Takes::nothing, Gives::nothing}.needs(Role::administrator),
    Route{"/api/v1/recorder/trends", Method::get, take<get_trends>, Takes::nothing, Gives::own}.asks("axes points from to columns"),
    Route{"/api/v1/recorder/steps", Method::get, take<get_recorded_steps>}.asks("axes from to"),
    Route{"/api/v1/recorder/captures", Method::get, take<list_captures>},
    Route{"/api/v1/recorder/captures", Method::post, take<arm_capture>, Takes::json}.needs(Role::operating),
    Route{"/api/v1/recorder/captures/{capture}", Method::get, take<get_capture>, Takes::nothing, Gives::own},
    Route{"/api/v1/recorder/captures/{capture}", Method::patch, take<rename_capture>, Takes::patch}
        .needs(Role::operating)
        .leaves("capture", "capture {} was renamed to {name}"),
    Route{"/api/v1/recorder/captures/{capture}", Method::remove, take<remove_capture>, Takes::nothing, Gives::nothing}
        .needs(Role::operating)
        .leaves("capture", "capture {} was deleted"),
    Route{"/api/v1/recorder/recordings", Method::get, take<list_recordings>},
    Route{"/api/v1/recorder/recordings", Method::post, take<make_recording>, Takes::json}.needs(Role::operating),
    Route{"/api/v1/recorder/recordings/{recording}", Method::get, take<get_recording>, Takes::nothing, Gives::own},
    Route{"/api/v1/recorder/recordings/{recording}/playback", Method::get, take<play_back_recording>}.asks("at frames columns"),
    Route{"/api/v1/recorder/recordings/{recording}", Method::patch, take<rename_recording>, Takes::patch}
        .needs(Role::operating)
        .leaves("recording", "recording {} was renamed to {name}"),
    Route{"/api/v1/recorder/recordings/{recording}", Method::remove, take<remove_recording>, Takes::nothing, Gives::nothing}
        .needs(Role::operating)
        .leaves("recording", "recording {} was deleted"),
    Route{"/api/v1/eds", Method::get, take<get_eds>, Takes::nothing, Gives::own},
    Route{"/api/v1/descriptions", Method::get, take<list_descriptions>},
    Route{"/api/v1/descriptions", Method::post, take<add_description>, Takes::eds}.asks("name"),
    Route{"/api/v1/descriptions/{description}", Method::get, take<get_drive_description>, Takes::nothing, Gives::own}.asks("format"),
    Route{"/api/v1/descriptions/{description}/objects", Method::get, take<get_description_objects>},
    Route{"/api/v1/descriptions/{description}", Method::remove, take<remove_description>, Takes::nothing, Gives::nothing},
    Route{"/api/v1/fail_safe", Method::get, take<get_fail_safe>},
    Route{"/api/v1/fail_safe/rehearsal", Method::get, take<get_rehearsal>},
    Route{"/api/v1/fail_safe/rehearsal", Method::post, take<start_rehearsal>, Takes::json},
    Route{"/api/v1/fail_safe/{axis}", Method::get, take<get_axis_fail_safe>},
    Route{"/api/v1/fail_safe/{axis}", Method::put, take<put_axis_fail_safe>, Takes::json},
    Route{"/api/v1/registers", Method::get, take<get_registers>}.asks("unit table address count"),
    Route{"/api/v1/mappings/list", Method::get, take<get_mapping_list>, Takes::nothing, Gives::own}.asks("format"),
    Route{"/api/v1/mappings/next-free", Method::get, take<get_next_free>}.asks("unit table words align"),
    Route{"/api/v1/mappings/units", Method::get, take<list_mapping_units>},
    Route{"/api/v1/mappings/units/{unit}", Method::put, take<change_mapping_unit>, Takes::json},
    Route{"/api/v1/fleet", Method::get, take<get_fleet>},
    Route{"/api/v1/fleet/{gateway}/axes/{axis}/commands", Method::post, take<command_fleet_axis>, Takes::json}
        .asks("wait")
        .needs(Role::viewer)
        .leaves("fleet", "{command} was given to {}/{}")
        .moves(),  // as above
    Route{"/api/v1/assemblies", Method::get, take<list_assemblies>},
    Route{"/api/v1/assemblies.csv", Method::get, take<get_assemblies_csv>, Takes::nothing, Gives::own},
    Route{"/api/v1/assemblies.csv", Method::post, take<add_assemblies_csv>, Takes::csv}.asks("dry_run"),
    Route{"/api/v1/assemblies.csv", Method::put, take<replace_assemblies_csv>, Takes::csv}.asks("dry_run"),
    Route{"/api/v1/assemblies/{instance}", Method::get, take<get_assembly>},
    Route{"/api/v1/assemblies/{instance}", Method::put, take<put_assembly>, Takes::json},
    Route{"/api/v1/assemblies/{instance}", Method::remove, take<remove_assembly>, Takes::nothing, Gives::nothing},
    Route{"/api/v1/profiles", Method::get, take<list_profiles>},
    Route{"/api/v1/profiles/{unit}", Method::get, take<get_profile>},
    Route{"/api/v1/profiles/{unit}", Method::put, take<put_profile>, Takes::json},
    Route{"/api/v1/profiles/{unit}", Method::remove, take<remove_profile>, Takes::nothing, Gives::nothing},
    Route{"/api/v1/mappings/template", Method::post, take<add_mapping_template>, Takes::json},
    Route{"/api/v1/events", Method::get, take<list_events>, Takes::nothing, Gives::own}.asks(
        "since axis severity kind state before limit order format"),
    Route{"/api/v1/alarms", Method::get, take<list_alarms>}.asks("state"),
    Route{"/api/v1/alarms/acknowledge", Method::post, take<acknowledge_alarms>, Takes::json}.needs(Role::operating),
    Route{"/api/v1/alarms/{alarm}/acknowledge", Method::post, take<acknowledge_alarm>, Takes::json}.needs(Role::operating),
    Route{"/api/v1/alarms/{alarm}/shelve", Method::post, take<shelve_alarm>, Takes::json}.needs(Role::operating),
    Route{"/api/v1/alarms/{alarm}/unshelve", Method::post, take<unshelve_alarm>}.needs(Role::operating),
    Route{"/api/v1/recipes", Method::get, take<list_recipes>},
    Route{"/api/v1/recipes/{recipe}", Method::get, take<get_recipe>},
    Route{"/api/v1/recipes/{recipe}", Method::put, take<put_recipe>, Takes::json}.asks("dry_run"),
    Route{"/api/v1/recipes/{recipe}", Method::remove, take<remove_recipe>, Takes::nothing, Gives::nothing},
    Route{"/api/v1/recipes/{recipe}/run", Method::post, take<run_recipe>, Takes::json}.needs(Role::operating).moves(),
    Route{"/api/v1/recipes/{recipe}/runs", Method::get, take<list_recipe_runs>},
    Route{"/api/v1/recipes/{recipe}/runs/{run}", Method::get, take<get_recipe_run>},
    Route{"/api/v1/recipes/{recipe}/runs/{run}/cancel", Method::post, take<cancel_recipe_run>}
        .needs(Role::operating)
        .leaves("recipe", "the end of recipe {} run {} was asked for"),
    Route{"/api/v1/recipes/{recipe}/rehearsal", Method::get, take<get_recipe_rehearsal>}.asks("first"),
    Route{"/api/v1/recipes/{recipe}/rehearsal", Method::post, take<rehearse_recipe>, Takes::json}.needs(Role::operating),
    Route{"/api/v1/recipes/{recipe}/rehearsal", Method::remove, take<cancel_recipe_rehearsal>}.needs(Role::operating),
    Route{"/api/v1/session", Method::get, take<get_session>}.needs(Role::none),
    Route{"/api/v1/session", Method::post, take<sign_in>, Takes::json}.needs(Role::none),
    Route{"/api/v1/session", Method::remove, take<sign_out>, Takes::nothing, Gives::nothing}.needs(Role::none),
    Route{"/api/v1/session/first", Method::post, take<first_sign_in>, Takes::json}.needs(Role::none),
    Route{"/api/v1/users", Method::get, take<list_users>}.needs(Role::administrator),
    Route{"/api/v1/users", Method::post, take<add_user>, Takes::json}.needs(Role::administrator),
    Route{"/api/v1/users/{user}", Method::get, take<get_user>}.needs(Role::administrator),
    Route{"/api/v1/users/{user}", Method::patch, take<change_user>, Takes::patch}.needs(Role::administrator),
    Route{"/api/v1/users/{user}", Method::remove, take<remove_user>, Takes::nothing, Gives::nothing}.needs(Role::administrator),
    Route{"/api/v1/users/{user}/password", Method::put, take<change_password>, Takes::json, Gives::nothing}.needs(Role::viewer),
    Route{"/api/v1/tokens", Method::get, take<list_tokens>},
    Route{"/api/v1/tokens", Method::post, take<add_token>, Takes::json}.needs(Role::viewer),
    Route{"/api/v1/tokens/{token}", Method::remove, take<remove_token>, Takes::nothing, Gives::nothing}.needs(Role::viewer),
    Route{"/api/v1/stream", Method::get, take<open_stream>, Takes::nothing, Gives::own, true},
};

}  // namespace

std::span<const Route> all_routes() noexcept { return routes; }

}  // namespace axisgate::http
