// The commands of `axisgate` other than the service: tables, decoding, checking, backup, single twins. The result goes to standard output
// and nothing else does; faults go to standard error. Exit code: 0 good, 1 failed, 2 wrong usage.
#pragma once

#include <string>
#include <vector>

#include "gateway/runtime/config.hpp"
#include "gateway/runtime/pki.hpp"

namespace axisgate {

inline constexpr int exit_good = 0, exit_failed = 1, exit_usage = 2;

struct ServeOptions {
    Config config;
    std::string site_file;    ///< replaces the stored site if given
    std::string config_file;  ///< the file from which `config` was read; included in backups
};
[[nodiscard]] int command_serve(const ServeOptions& options);

[[nodiscard]] int command_families(const std::string& format);
[[nodiscard]] int command_catalogue(const std::string& family, const std::string& what, const std::string& format);
/// Prints the freedoms of a family, or, if `specimen` is not empty, that specimen in words.
[[nodiscard]] int command_specimen(const std::string& family, const std::string& specimen, bool as_json);
[[nodiscard]] int command_decode(const std::string& family, const std::string& format, const std::string& file);
/// Plays a recording (.axr) again and prints the differences of this program.
[[nodiscard]] int command_replay(const std::string& file);
/// Reads configuration and site as `serve` would, and prints every fault with file, line and remedy. `all_read` false: a file of the
/// sources could not be read, which was reported already.
[[nodiscard]] int command_check(const ConfigSources& sources, const std::string& site_file, bool all_read = true);
/// `passphrase_file` empty: not sealed.
[[nodiscard]] int command_backup(const Config& config, const std::string& config_file, const std::string& file,
                                 const std::string& passphrase_file);
/// Asks the gateway of this configuration for its readiness: its text on standard output, and the exit code.
[[nodiscard]] int command_health(const Config& config);
/// Writes a support bundle; `config` was read from `sources`.
[[nodiscard]] int command_bundle(const ConfigSources& sources, const Config& config, const std::string& file);
/// Makes the certificates of a DDS domain and prints the new folders.
[[nodiscard]] int command_pki(const PkiOptions& options);
struct RestoreOptions {
    std::string file, passphrase_file;
    bool with_config = false;     ///< the configuration of the backup replaces that of this host, and its paths apply
    bool confirm_places = false;  ///< with_config: places outside the folder of the configuration are used, too
};
/// `config` was read from `sources`.
[[nodiscard]] int command_restore(Config config, const ConfigSources& sources, const RestoreOptions& options);

struct TwinOptions {
    std::string family;
    std::string line_uri;
    std::vector<std::string> addresses;
    std::string state_file;
    std::string hand_bind;
    double time_scale = 1.0;
    std::string specimen;              ///< a seed or a name; empty: the drive as its manual shows it
    std::vector<std::string> options;  ///< "name=value" for the twins
};
[[nodiscard]] int command_twin(const TwinOptions& options);

struct RehearseOptions {
    std::string site_file;   ///< empty: the stored site, with the memories of its twins
    std::string recipe;      ///< a stored recipe, or a file (*.json); empty: a program
    std::string program;     ///< a command that uses the Modbus or the EtherNet/IP door; empty: a recipe
    double time_scale = 10;  ///< of a program: how many times as fast the time of the gateway passes
    int limit_s = 600;       ///< of a program, in virtual time
    std::string specimens = "1..100";
    std::vector<std::string> fixed;      ///< "family=specimen"
    std::vector<std::string> arguments;  ///< "name=value" of the recipe
    bool json = false;
};
/// Plays a recipe or a program against specimens of the site's drives in virtual time and prints a table. Exit code 1 if it fails with one.
[[nodiscard]] int command_rehearse(const Config& config, const RehearseOptions& options);

struct CompareOptions {
    std::string family, file;
    std::string format;                  ///< empty: by the content of the file
    std::string interface;               ///< of a recording with several lines
    std::vector<std::string> addresses;  ///< empty: those that the recording shows (CAN), or the factory's
    std::vector<std::string> options;    ///< "name=value" for the twins
    std::string specimen;                ///< only this one; empty: 0, the named ones, and the seeds 1 to `seeds`
    int seeds = 50;
    std::string state_file;  ///< memory of the twins when the recording begins
    int tolerance_ms = 20;
    std::string line_uri;    ///< compares a drive on this line instead of a recording; `file` is empty then
    int channel = 1;         ///< with `line_uri`: the axis within the drive
    std::string adopt_file;  ///< with `line_uri`: the memory of a twin that is this drive is written here; empty: it is not
    bool json = false;
};
/// Compares a recorded drive with its twin. Exit code: 0 equal, 1 differences, 2 wrong usage, or a recording that cannot be compared.
[[nodiscard]] int command_compare(const CompareOptions& options);
/// Compares a drive on a line with its twin. Nothing is written to it. Exit code as command_compare; 2 if the drive does not answer.
[[nodiscard]] int command_compare_line(const CompareOptions& options);

/// "axisgate: TEXT" on standard error.
void complain(const std::string& text);
/// "PLACE: the fault; the remedy", with "warning: " before faults that `serve` tolerates.
void complain(const ConfigFault& fault);

}  // namespace axisgate
