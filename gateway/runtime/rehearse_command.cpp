// Plays a recipe or a program against many specimens of the drives of a site and prints one row for each. The gateway of this host may run:
// its database is only read, and no line is opened. The rehearsals share nothing, so each processor plays some of them.
#include <fmt/core.h>

#include <algorithm>
#include <atomic>
#include <boost/json/parse.hpp>
#include <boost/json/serialize.hpp>
#include <csignal>
#include <filesystem>
#include <thread>

#include "gateway/core/assets.hpp"
#include "gateway/core/json_read.hpp"
#include "gateway/doors/http/words.hpp"
#include "gateway/runtime/catalogues.hpp"
#include "gateway/runtime/command_tables.hpp"
#include "gateway/runtime/commands.hpp"
#include "gateway/runtime/files.hpp"
#include "gateway/runtime/rehearse_program.hpp"
#include "gateway/runtime/site_file.hpp"
#include "gateway/runtime/warm_descriptions.hpp"
#include "gateway/services/recipes/recipe.hpp"
#include "gateway/services/recipes/recipe_rehearsal.hpp"
#include "gateway/services/recipes/rehearsal_gateway.hpp"
#include "gateway/store/store.hpp"

namespace axisgate {
namespace json = boost::json;
namespace {

/// The order as it is put together; each function returns an exit code and has complained if that is not exit_good.
class RehearseOrder {
public:
    RehearseOrder(const Config& config, const RehearseOptions& options) : config_(config), options_(options) {}

    [[nodiscard]] int read() {
        auto families = families_or_complain();
        if (!families) return exit_failed;
        families_ = std::move(*families);
        families_.descriptions = std::make_shared<DescriptionShelf>();
        std::string wrong;
        specimens_ = read_specimens(options_.specimens, wrong);
        if (!wrong.empty()) return usage("--specimens: " + wrong);
        if (options_.recipe.empty() && options_.program.empty())
            return usage("--recipe: name a stored recipe or a file of one, such as cycle.json; or --program: a command of the shell");
        if (const int code = pairs(); code != exit_good) return code;
        const bool stored_recipe = options_.program.empty() && !recipe_is_file();
        if ((options_.site_file.empty() || stored_recipe) && !open_store()) return exit_failed;
        if (const int code = read_site(); code != exit_good) return code;
        if (options_.program.empty()) {
            if (const int code = read_recipe_document(); code != exit_good) return code;
        } else if (!wish_.arguments.empty()) {
            return usage("--argument: only a recipe has arguments; write those of the program into its command");
        }
        wish_.lease = std::chrono::seconds(config_.authority_lease_s);
        wish_.by = {http::clients, std::make_shared<const std::string>("axisgate rehearse"), nullptr};
        return exit_good;
    }

    [[nodiscard]] int play() { return options_.program.empty() ? play_recipe() : play_program(); }

private:
    [[nodiscard]] int play_recipe() {
        std::vector<SiteFault> faults;
        const RecipeRehearsal rehearsal(families_, std::move(wish_), faults);
        for (const auto& f : faults)
            complain(text_.empty() ? fmt::format("{} {}: {}; {}", options_.recipe, f.pointer, f.text, f.remedy)
                                   : fmt::format("{}:{}: {} ({}); {}", options_.recipe, line_of_pointer(text_, f.pointer), f.text,
                                                 f.pointer.empty() ? "/" : f.pointer, f.remedy));
        if (!faults.empty()) return exit_usage;
        return play_each([&](const std::string& specimen) { return rehearsal.play(specimen); });
    }

    [[nodiscard]] int play_program() {
        std::vector<SiteFault> faults;
        check_fixed(wish_.fixed, families_, faults);
        if (wish_.site.axes.empty()) faults.push_back({"", "the site has no axis", "give one with axes", false});
        for (const auto& f : faults)
            complain(fmt::format("{}; {}", f.text, f.remedy));
        if (!faults.empty()) return exit_usage;
        (void)std::signal(SIGPIPE, SIG_IGN);  // a program may end while the door answers it
        ProgramRehearsalWish all;
        all.command = options_.program;
        all.time_scale = options_.time_scale;
        all.limit = std::chrono::seconds(options_.limit_s);
        all.site = simulated_site(wish_.site, families_);
        all.memory = wish_.memory;
        all.lease = wish_.lease;
        all.registers.word_order = config_.low_word_first ? MapWordOrder::low_first : MapWordOrder::high_first;
        all.registers.gaps = config_.map_gaps;
        std::vector<std::string> unread;
        all.registers.languages = load_languages(unread);
        for (const auto& fault : unread)
            complain(fault);
        return play_each([&](const std::string& specimen) {
            ProgramRehearsalWish one = all;
            one.site = site_of_specimen(std::move(one.site), specimen, wish_.fixed);
            return rehearse_program(families_, one, specimen);
        });
    }

    /// As many at once as there are processors.
    template <class Play>
    [[nodiscard]] int play_each(const Play& play) {
        std::vector<RehearsedSpecimen> rows(specimens_.size());
        std::atomic<std::size_t> next{0};
        const auto work = [&] {
            for (std::size_t i = next++; i < rows.size(); i = next++)
                rows[i] = play(specimens_[i]);
        };
        std::vector<std::jthread> others;
        for (std::size_t i = 1; i < std::min<std::size_t>(std::thread::hardware_concurrency(), rows.size()); ++i)
            others.emplace_back(work);
        work();
        others.clear();
        return print(rows);
    }

    static int usage(const std::string& text) {
        complain(text);
        return exit_usage;
    }
    [[nodiscard]] bool recipe_is_file() const { return options_.recipe.ends_with(".json"); }

    [[nodiscard]] int pairs() {
        for (const std::string& x : options_.fixed) {
            const auto equals = x.find('=');
            if (equals == std::string::npos || equals == 0) return usage("--family-specimen: write FAMILY=N, such as uim342=slow");
            wish_.fixed[x.substr(0, equals)] = x.substr(equals + 1);
        }
        for (const std::string& x : options_.arguments) {
            const auto equals = x.find('=');
            if (equals == std::string::npos || equals == 0) return usage("--argument: write NAME=VALUE, such as speed=20");
            boost::system::error_code ec;  // a value that is no JSON is a text
            auto value = json::parse(x.substr(equals + 1), ec);
            wish_.arguments[x.substr(0, equals)] = ec ? json::value(x.substr(equals + 1)) : std::move(value);
        }
        return exit_good;
    }

    [[nodiscard]] bool open_store() {
        StoreOptions options;
        options.directory = config_.data_dir;
        if (const auto migrations = migrations_among(all_assets())) options.migrations = *migrations;
        auto reader = StoreReader::open(options);
        std::string fault = reader ? "" : reader.error().text;
        if (reader) fill_shelf(**reader, *families_.descriptions, fault);
        if (!fault.empty()) {
            complain(fmt::format("{}; without a database give --site FILE.json and --recipe FILE.json", fault));
            return false;
        }
        reader_ = std::move(*reader);
        return true;
    }

    [[nodiscard]] int read_site() {
        if (!options_.site_file.empty()) {
            auto read = read_site_file(options_.site_file, families_);
            for (const auto& f : read.faults)
                complain(f);
            if (!read.site) return exit_usage;
            wish_.site = std::move(*read.site);
            return exit_good;
        }
        const auto stored = reader_->load_site();
        boost::system::error_code ec;
        std::vector<SiteFault> faults;
        auto site = stored && *stored ? parse_site(json::parse((*stored)->text, ec), families_, faults) : std::nullopt;
        if (!site) {
            complain(!stored ? stored.error().text : "there is no stored site that this program can read; give --site FILE.json");
            return exit_failed;
        }
        wish_.site = std::move(*site);
        wish_.memory = read_site_memory(*reader_, wish_.site);
        return exit_good;
    }

    [[nodiscard]] int read_recipe_document() {
        std::string text;
        if (recipe_is_file()) {
            std::string fault;
            const auto read = read_file(options_.recipe, fault, most_recipe_bytes);
            if (!read) return usage(fault);
            text_ = text = *read;
            wish_.name = std::filesystem::path(options_.recipe).stem().string();
        } else {
            const auto kept = reader_->document("recipe", options_.recipe);
            if (!kept || !*kept)
                return usage(fmt::format("there is no stored recipe {}; for a file write its name with .json", options_.recipe));
            text = (*kept)->text;
            wish_.name = options_.recipe;
        }
        JsonFault unread;
        const auto document = read_json(text, unread);
        if (!document || !document->is_object())
            return usage(fmt::format("{}:{}: a recipe is a JSON object {}", options_.recipe, unread.line,
                                     unread.text.empty() ? "" : "(" + unread.text + ")"));
        wish_.document = document->get_object();
        for (const auto* member : {"name", "changed_at", "changed_by"})  // a recipe as the API shows it
            wish_.document.erase(member);
        return exit_good;
    }

    [[nodiscard]] int print(const std::vector<RehearsedSpecimen>& rows) const {
        const auto passed = static_cast<std::size_t>(std::ranges::count(rows, true, &RehearsedSpecimen::passed));
        if (options_.json) {
            json::array list;
            for (const auto& r : rows)
                list.push_back(to_json(r));
            fmt::print("{}\n", json::serialize(json::object{{options_.program.empty() ? "recipe" : "program",
                                                             options_.program.empty() ? options_.recipe : options_.program},
                                                            {"passed", passed},
                                                            {"failed", rows.size() - passed},
                                                            {"specimens", std::move(list)}}));
        } else {
            std::vector<TableRow> table;
            for (const auto& r : rows)
                table.push_back({r.specimen, r.passed ? "passed" : "failed", fmt::format("{:.3f}", r.seconds), r.passed ? "" : r.step,
                                 r.text, r.event});
            print_table({"specimen", "result", "seconds", "step", "reason", "newest warning"}, table);
            fmt::print("{} of {} specimens passed\n", passed, rows.size());
        }
        return passed == rows.size() ? exit_good : exit_failed;
    }

    const Config& config_;
    const RehearseOptions& options_;
    Families families_;
    std::unique_ptr<StoreReader> reader_;
    std::vector<std::string> specimens_;
    RecipeRehearsalWish wish_;
    std::string text_;  ///< of the recipe's file, for the lines of faults; empty: it is stored
};
}  // namespace

int command_rehearse(const Config& config, const RehearseOptions& options) {
    RehearseOrder order(config, options);
    const int code = order.read();
    return code == exit_good ? order.play() : code;
}

}  // namespace axisgate
