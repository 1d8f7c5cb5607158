// Commands: the parts of `axisgate` that are not the service: tables, decoding, checking, backup, single twins.
// In: arguments. Out: text on standard output, faults on standard error, an exit code (0 good, 1 failed, 2 wrong usage).
// Never prints anything but what was asked for on standard output.
#pragma once

#include <string>
#include <vector>

#include "gateway/runtime/config.hpp"
#include "gateway/runtime/pki.hpp"

namespace axisgate {

inline constexpr int exit_good = 0, exit_failed = 1, exit_usage = 2;

struct ServeOptions {
    Config config;
    std::string site_file;    ///< replaces the stored site when it is given
    std::string config_file;  ///< that `config` was read from; goes into backups
};
[[nodiscard]] int command_serve(const ServeOptions& options);

[[nodiscard]] int command_families(const std::string& format);
[[nodiscard]] int command_catalogue(const std::string& family, const std::string& what, const std::string& format);
[[nodiscard]] int command_decode(const std::string& family, const std::string& format, const std::string& file);
/// Plays a recording (.axr) again and prints where this program does otherwise.
[[nodiscard]] int command_replay(const std::string& file);
/// Reads configuration and site as `serve` would; prints every fault with file, line and remedy. `all_read` false: a file of the sources
/// could not be read, which has been said already.
[[nodiscard]] int command_check(const ConfigSources& sources, const std::string& site_file, bool all_read = true);
/// `passphrase_file` empty: not sealed.
[[nodiscard]] int command_backup(const Config& config, const std::string& config_file, const std::string& file,
                                 const std::string& passphrase_file);
/// Asks the gateway of this configuration whether it is well: its word on standard output, and the exit code.
[[nodiscard]] int command_health(const Config& config);
/// Writes a support bundle; `sources` are those that `config` was read from.
[[nodiscard]] int command_bundle(const ConfigSources& sources, const Config& config, const std::string& file);
/// Makes the certificates of a DDS domain; prints the folders that were made.
[[nodiscard]] int command_pki(const PkiOptions& options);
struct RestoreOptions {
    std::string file, passphrase_file;
    bool with_config = false;     ///< the configuration of the backup takes the place of this host's, and its paths hold
    bool confirm_places = false;  ///< with_config: places outside the folder of the configuration are taken, too
};
/// `sources` are those that `config` was read from.
[[nodiscard]] int command_restore(Config config, const ConfigSources& sources, const RestoreOptions& options);

struct TwinOptions {
    std::string family;
    std::string line_uri;
    std::vector<std::string> addresses;
    std::string state_file;
    std::string hand_bind;
    double time_scale = 1.0;
    std::vector<std::string> options;  ///< "name=value" for the twins
};
[[nodiscard]] int command_twin(const TwinOptions& options);

/// "axisgate: TEXT" on standard error.
void complain(const std::string& text);
/// "PLACE: what is wrong; what to do", with "warning: " in front of what goes on without it.
void complain(const ConfigFault& fault);

}  // namespace axisgate
