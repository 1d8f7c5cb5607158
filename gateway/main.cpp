// axisgate: start here. Reads the command line and hands over to the command that was named.
// In: arguments, the environment. Out: the exit code (0 good, 1 failed, 2 wrong usage or configuration). Never does the work itself.
#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <string>
#include <vector>

#include "gateway/runtime/commands.hpp"
#include "gateway/runtime/doors.hpp"
#include "gateway/runtime/files.hpp"

extern char** environ;

namespace {
using namespace axisgate;

struct Common {
    std::string config_file, data_dir, site_file;
    std::vector<std::string> set;
};

ConfigSources sources_of(const Common& c, bool& good) {
    ConfigSources s;
    s.file_name = c.config_file;
    if (!c.config_file.empty()) {
        std::string fault;
        s.file_text = read_file(c.config_file, fault, 1u << 20);
        if (!s.file_text) {
            complain(fault);
            good = false;
        }
    }
    for (char** e = environ; e && *e; ++e) {
        if (std::string_view(*e).starts_with("AXISGATE_")) s.environment.emplace_back(*e);
    }
    if (!c.data_dir.empty()) s.overrides.push_back("data.dir=" + c.data_dir);
    for (const auto& o : c.set)
        s.overrides.push_back(o);
    return s;
}

bool config_of(const Common& c, Config& config) {
    bool good = true;
    const auto sources = sources_of(c, good);
    std::vector<ConfigFault> faults;
    config = read_config(sources, faults);
    for (const auto& f : faults)
        complain(f);
    return good && faults.empty();
}

void add_config(CLI::App& app, Common& c, bool site) {
    app.add_option("--config", c.config_file, "TOML file of this host")->type_name("FILE.toml");
    app.add_option("--data", c.data_dir, "data directory (default ./var)")->type_name("DIR");
    if (site) app.add_option("--site", c.site_file, "site document to put in force")->type_name("FILE.json");
    app.add_option("--set", c.set, "one value of the configuration, such as http.bind=127.0.0.1:8081; may be repeated")
        ->type_name("SECTION.KEY=VALUE")
        ->allow_extra_args(false);
}
/// The command line: its commands in the order in which help lists them, and what each of them takes.
struct CommandLine {
    explicit CommandLine(CLI::App& a) : app(a) {
        app.set_version_flag("--version", "axisgate " AXISGATE_VERSION);
        app.require_subcommand(1);
        app.fallthrough(false);
        serve = app.add_subcommand("serve", "run the gateway");
        add_config(*serve, serve_common, true);
        add_twin();
        add_families();
        add_compare();
        check = app.add_subcommand("check", "find all faults of configuration and site");
        add_config(*check, check_common, true);
        add_backup();
        health = app.add_subcommand("health", "ask the gateway that runs here whether it is well; the exit code says it");
        add_config(*health, health_common, false);
        add_pki();
        version = app.add_subcommand("version", "print the version");
        help = app.add_subcommand("help", "print this text");
    }

    void add_twin() {
        twin = app.add_subcommand("twin", "run embedded drives by themselves on a line that anything can open");
        twin->add_option("family", twin_options.family, "family, see `axisgate families`")->required()->type_name("FAMILY");
        twin->add_option("--line", twin_options.line_uri,
                         "can:can0, serial:/dev/ttyUSB0?baud=57600, tcp-listen:HOST:PORT, tcp:HOST:PORT, udp-listen:HOST:PORT or pty:PATH, "
                         "pty:PATH?baud=9600 at the pace of a serial port")
            ->required()
            ->type_name("URI");
        twin->add_option("--address", twin_options.addresses, "address of a drive; may be repeated")
            ->type_name("A")
            ->allow_extra_args(false);
        twin->add_option("--state", twin_options.state_file, "file of the non-volatile memory: read at the start, written at each change")
            ->type_name("FILE");
        twin->add_option("--hand", twin_options.hand_bind, "serve the tester's hand (inputs, stall, power ...) over HTTP here")
            ->type_name("HOST:PORT");
        twin->add_option("--time-scale", twin_options.time_scale, "how many times as fast the drives' clock runs, 0.001 to 10000")
            ->type_name("X");
        twin->add_option("--specimen", twin_options.specimen,
                         "which drive of the family: a seed, or slow, sparse, strict, chatty, weak, old")
            ->type_name("N|NAME");
        twin->add_option("--option", twin_options.options, "an option of the family, such as crc=13; may be repeated")
            ->type_name("NAME=VALUE")
            ->allow_extra_args(false);
    }

    void add_families() {
        families = app.add_subcommand("families", "list the drive families of this program");
        families->add_option("--format", families_format, "table or json")->check(CLI::IsMember({"table", "json"}));

        catalogue = app.add_subcommand("catalogue", "what a family has: parameters, commands, errors");
        catalogue->add_option("family", catalogue_family)->required()->type_name("FAMILY");
        catalogue->add_option("what", catalogue_what, "parameters, commands or errors")
            ->check(CLI::IsMember({"parameters", "commands", "errors"}));
        catalogue->add_option("--format", catalogue_format, "table, csv or json")->check(CLI::IsMember({"table", "csv", "json"}));

        specimen = app.add_subcommand("specimen", "the freedoms of a family's simulated drive, or one specimen of it in words");
        specimen->add_option("family", specimen_family, "family, see `axisgate families`")->required()->type_name("FAMILY");
        specimen
            ->add_option("specimen", specimen_name,
                         "a seed (0 is the drive as its manual shows it), or slow, sparse, strict, chatty, weak, old")
            ->type_name("N|NAME");
        specimen->add_flag("--json", specimen_json, "as JSON");

        decode = app.add_subcommand("decode", "one readable line per recorded frame");
        decode->add_option("family", decode_family)->required()->type_name("FAMILY");
        decode->add_option("--format", decode_format, "candump, hex (lines of bytes, > to the drive, < from it), trace, pcapng or axr")
            ->check(CLI::IsMember({"candump", "hex", "trace", "pcapng", "axr"}));
        decode->add_option("file", decode_file, "recorded line; - or nothing: standard input")->type_name("FILE");

        add_rehearse();

        replay = app.add_subcommand("replay", "play a recording again, and tell where this program does otherwise");
        replay->add_option("file", replay_file)->required()->type_name("FILE.axr");
    }

    void add_rehearse() {
        rehearse = app.add_subcommand("rehearse", "run a recipe or a program in virtual time against many specimens of the site's drives");
        auto* recipe = rehearse->add_option("--recipe", rehearse_options.recipe, "name of a stored recipe, or a file (.json)")
                           ->type_name("NAME|FILE.json");
        auto* program = rehearse
                            ->add_option("--program", rehearse_options.program,
                                         "a command of the shell that commands the axes over Modbus/TCP or EtherNet/IP, at the address "
                                         "AXISGATE_MODBUS or AXISGATE_ENIP of its environment")
                            ->type_name("COMMAND")
                            ->excludes(recipe);
        rehearse
            ->add_option("--time-scale", rehearse_options.time_scale,
                         "with --program: how many times as fast the time passes, 0.1 to 1000 (default 10)")
            ->check(CLI::Range(0.1, 1000.0))
            ->needs(program)
            ->type_name("X");
        rehearse->add_option("--limit", rehearse_options.limit_s, "with --program: its longest virtual time in seconds (default 600)")
            ->check(CLI::Range(1, 86400))
            ->needs(program)
            ->type_name("S");
        rehearse->add_option("--specimens", rehearse_options.specimens, "seeds and names, such as 1..100 (default) or 0,17,slow,weak")
            ->type_name("LIST");
        rehearse
            ->add_option("--family-specimen", rehearse_options.fixed,
                         "drives of this family are the same specimen in all runs; may be repeated")
            ->type_name("FAMILY=N")
            ->allow_extra_args(false);
        rehearse->add_option("--argument", rehearse_options.arguments, "an argument of the recipe; may be repeated")
            ->type_name("NAME=VALUE")
            ->allow_extra_args(false);
        rehearse->add_flag("--json", rehearse_options.json, "as JSON");
        add_config(*rehearse, rehearse_common, false);
        rehearse->add_option("--site", rehearse_options.site_file, "site document with the drives (default: the stored site)")
            ->type_name("FILE.json");
    }

    void add_compare() {
        compare = app.add_subcommand("compare",
                                     "tell where a drive and its twin differ: a recorded drive, or one on a line, which is only asked");
        compare->add_option("family", compare_options.family, "family, see `axisgate families`")->required()->type_name("FAMILY");
        compare->add_option("recording", compare_options.file, "recorded line of a real drive; -: standard input")->type_name("RECORDING");
        auto* line = compare->add_option("--line", compare_options.line_uri, "compare a drive on this line instead of a recording")
                         ->type_name("URI");
        compare->add_option("--channel", compare_options.channel, "with --line: the axis within the drive (default 1)")
            ->check(CLI::Range(1, 64))
            ->needs(line)
            ->type_name("N");
        compare
            ->add_option("--adopt", compare_options.adopt_file,
                         "with --line: write the values of the drive as the memory of its twin, for --state and `twin --state`")
            ->needs(line)
            ->type_name("FILE");
        compare
            ->add_option("--format", compare_options.format,
                         "candump, hex (lines as `(SECONDS) > BYTES`, > to the drive, < from it), trace, pcapng or axr; without it the "
                         "content decides")
            ->check(CLI::IsMember({"candump", "hex", "trace", "pcapng", "axr"}));
        compare->add_option("--interface", compare_options.interface, "the line to compare, if the recording has several")
            ->type_name("NAME");
        compare->add_option("--address", compare_options.addresses, "address of the drive; may be repeated for a recording")
            ->type_name("A")
            ->allow_extra_args(false);
        compare->add_option("--option", compare_options.options, "an option of the twin, such as crc=13; may be repeated")
            ->type_name("NAME=VALUE")
            ->allow_extra_args(false);
        compare->add_option("--state", compare_options.state_file, "the drive's memory when the recording begins, as of `twin --state`")
            ->type_name("FILE");
        compare->add_option("--specimen", compare_options.specimen, "only this specimen: a seed or a name")->type_name("N");
        compare
            ->add_option("--seeds", compare_options.seeds,
                         "without --specimen: how many seeds are tried beside 0 and the names (default 50)")
            ->check(CLI::Range(0, 1000))
            ->type_name("N");
        compare
            ->add_option("--tolerance-ms", compare_options.tolerance_ms,
                         "by how much a reply time may be outside the specimen's range (default 20)")
            ->check(CLI::Range(0, 10000))
            ->type_name("MS");
        compare->add_flag("--json", compare_options.json, "the whole result as JSON");
    }

    void add_backup() {
        constexpr const char* passphrase_help =
            "file with the passphrase that it is sealed with, at least 12 characters; -: standard input";
        backup = app.add_subcommand("backup", "copy database, certificates and configuration into one file; the gateway may run");
        backup->add_option("file", backup_file)->required()->type_name("FILE");
        backup->add_option("--passphrase-file", backup_passphrase_file, passphrase_help)->type_name("FILE");
        add_config(*backup, backup_common, false);
        restore = app.add_subcommand("restore", "put a backup in place of the database and the certificates; the gateway must not run");
        restore->add_option("file", restore_options.file)->required()->type_name("FILE");
        restore->add_option("--passphrase-file", restore_options.passphrase_file, passphrase_help)->type_name("FILE");
        restore->add_flag("--with-config", restore_options.with_config,
                          "the configuration in the backup takes the place of the file of --config, and its paths hold");
        restore->add_flag("--confirm-places", restore_options.confirm_places,
                          "with --with-config: take the places that were shown, which lie outside the folder of the configuration");
        add_config(*restore, restore_common, false);

        bundle =
            app.add_subcommand("bundle", "gather what somebody needs who is to help, without secrets, in one tar; the gateway may run");
        bundle->add_option("file", bundle_file)->required()->type_name("FILE.tar");
        add_config(*bundle, bundle_common, false);
    }

    void add_pki() {
        pki = app.add_subcommand("pki", "make the certificates of a DDS domain: a folder for each member, for [dds] security");
        pki->add_option("dir", pki_options.dir, "folder of the authority, which is made where there is none; keep it off the gateways")
            ->required()
            ->type_name("DIR");
        pki->add_option("names", pki_options.names, "members, as [dds] name")->required()->type_name("NAME...");
        pki->add_option("--role", pki_options.role, "gateway, commander (commands and sees) or viewer (sees)")
            ->check(CLI::IsMember({"gateway", "commander", "viewer"}));
        pki->add_option("--partition", pki_options.partition, "the plant, as [dds] partition (default plant)")->type_name("NAME");
        pki->add_option("--days", pki_options.days, "for how long they hold (default 3650)")->check(CLI::Range(1, 36500))->type_name("N");
    }

    /// What is wrong with a command line that cannot be read.
    [[nodiscard]] int refuse(const CLI::ParseError& e, int argc, char** argv) const {
        if (e.get_exit_code() == 0) return app.exit(e);
        std::string names;
        bool known = false;
        for (const auto* s : app.get_subcommands({})) {
            names += (names.empty() ? "" : ", ") + s->get_name();
            known = known || (argc > 1 && s->get_name() == argv[1]);
        }
        if (argc > 1 && argv[1][0] != '-' && !known) {
            complain(fmt::format("there is no command {}; commands: {}; see `axisgate help`", argv[1], names));
            return exit_usage;
        }
        complain(std::string(e.what()) + "; see `axisgate help`");
        return exit_usage;
    }

    [[nodiscard]] int run() {
        if (*version) {
            fmt::print("axisgate {}\n", AXISGATE_VERSION);
            return exit_good;
        }
        if (*help) {
            fmt::print("{}", app.get_formatter()->make_help(&app, "axisgate", CLI::AppFormatMode::All));
            return exit_good;
        }
        if (*pki) return command_pki(pki_options);
        if (*families) return command_families(families_format);
        if (*catalogue) return command_catalogue(catalogue_family, catalogue_what, catalogue_format);
        if (*specimen) return command_specimen(specimen_family, specimen_name, specimen_json);
        if (*decode) return command_decode(decode_family, decode_format, decode_file);
        if (*replay) return command_replay(replay_file);
        if (*compare) return compare_options.line_uri.empty() ? command_compare(compare_options) : command_compare_line(compare_options);
        if (*twin) return command_twin(twin_options);
        if (*check) {
            bool good = true;
            const auto sources = sources_of(check_common, good);
            return command_check(sources, check_common.site_file, good);
        }
        if (*serve) {
            ServeOptions o;
            if (!config_of(serve_common, o.config)) return exit_usage;
            o.site_file = serve_common.site_file;
            o.config_file = serve_common.config_file;
            return command_serve(o);
        }
        Config config;
        if (*bundle) {
            if (!config_of(bundle_common, config)) complain("the bundle is made all the same, with what could be read");
            bool read = true;
            return command_bundle(sources_of(bundle_common, read), config, bundle_file);
        }
        if (*rehearse) return config_of(rehearse_common, config) ? command_rehearse(config, rehearse_options) : exit_usage;
        if (*health) return config_of(health_common, config) ? command_health(config) : exit_usage;
        if (*backup) {
            if (!config_of(backup_common, config)) return exit_usage;
            return command_backup(config, backup_common.config_file, backup_file, backup_passphrase_file);
        }
        if (*restore) {
            bool read = true;
            if (!config_of(restore_common, config)) return exit_usage;
            return command_restore(config, sources_of(restore_common, read), restore_options);
        }
        return exit_usage;
    }

    CLI::App& app;
    CLI::App *serve = nullptr, *twin = nullptr, *families = nullptr, *catalogue = nullptr, *specimen = nullptr, *decode = nullptr,
             *rehearse = nullptr, *replay = nullptr, *compare = nullptr, *check = nullptr, *backup = nullptr, *restore = nullptr,
             *bundle = nullptr, *health = nullptr, *pki = nullptr, *version = nullptr, *help = nullptr;
    Common serve_common, check_common, rehearse_common, backup_common, restore_common, bundle_common, health_common;
    TwinOptions twin_options;
    CompareOptions compare_options;
    std::string families_format = "table";
    std::string catalogue_family, catalogue_what = "parameters", catalogue_format = "table";
    std::string specimen_family, specimen_name;
    bool specimen_json = false;
    std::string decode_family, decode_format = "candump", decode_file = "-";
    RehearseOptions rehearse_options;
    std::string replay_file;
    std::string backup_file, backup_passphrase_file, bundle_file;
    RestoreOptions restore_options;
    PkiOptions pki_options;
};
}  // namespace

int main(int argc, char** argv) {
    CLI::App app{"axisgate: a gateway between Modbus, HTTP and motor drives, with an embedded model of each drive"};
    CommandLine line(app);
    if (const std::string fault = bring_doors(); !fault.empty()) {
        complain(fault);
        return exit_failed;
    }
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& e) {
        return line.refuse(e, argc, argv);
    }
    return line.run();
}
