// Compares schema/openapi.yaml with the program in both directions: routes and methods, and the required members of documents. The file is
// read by its indentation, which its head comment guarantees: paths at two spaces, methods at four, schemas at four.
#include <fstream>
#include <map>
#include <set>
#include <sstream>

#include "gateway/services/documents.hpp"
#include "tests/unit/http/harness.hpp"

namespace axisgate::http::test {
namespace {
namespace json = boost::json;

std::vector<std::string> lines_of_description() {
    std::ifstream file(AXISGATE_SOURCE_DIR "/schema/openapi.yaml");
    EXPECT_TRUE(file) << "schema/openapi.yaml cannot be read";
    std::vector<std::string> out;
    for (std::string line; std::getline(file, line);)
        out.push_back(line);
    return out;
}

std::size_t indent_of(const std::string& line) { return line.find_first_not_of(' '); }

using Operations = std::set<std::pair<std::string, std::string>>;

Operations described() {
    Operations out;
    bool in_paths = false;
    std::string path;
    for (const auto& line : lines_of_description()) {
        const auto indent = indent_of(line);
        if (indent == std::string::npos || line[indent] == '#') continue;
        if (indent == 0) in_paths = line == "paths:";
        if (!in_paths || line.back() != ':') continue;
        const std::string key = line.substr(indent, line.size() - indent - 1);
        if (indent == 2) path = key;
        if (indent == 4 && key != "parameters") {
            std::string method = key;
            for (auto& c : method)
                c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
            out.emplace(path, method);
        }
    }
    return out;
}

/// The `required` list of a schema, including its `allOf` parts and the schemas that they name; nested objects are not examined.
void required_of(const std::string& schema, std::set<std::string>& out) {
    bool in_schemas = false, in_schema = false, found = false;
    std::string list;
    bool in_list = false;
    for (const auto& line : lines_of_description()) {
        const auto indent = indent_of(line);
        if (indent == std::string::npos) continue;
        if (indent == 2) in_schemas = line == "  schemas:";
        if (in_schemas && indent == 4) in_schema = line == "    " + schema + ":";
        if (!in_schemas || !in_schema) continue;
        found = true;
        const std::string text = line.substr(indent);
        if (indent == 8 && text.starts_with("- {$ref: '#/components/schemas/")) {
            required_of(text.substr(31, text.find('\'', 31) - 31), out);
        }
        if ((indent == 6 || indent == 10) && text.starts_with("required: [")) {
            in_list = true;
            list.clear();
        }
        if (in_list) {
            list += text;
            if (text.ends_with(']')) {
                in_list = false;
                list = list.substr(11, list.size() - 12);
                std::stringstream words(list);
                for (std::string word; std::getline(words, word, ',');) {
                    word.erase(0, word.find_first_not_of(' '));
                    out.insert(word);
                }
            }
        }
    }
    EXPECT_TRUE(found) << "no schema " << schema;
}

TEST(OpenApi, RoutesAreThoseOfTheDescriptionInBothDirections) {
    Operations registered;
    for (const auto& r : all_routes())
        EXPECT_TRUE(registered.emplace(std::string(r.path), std::string(name_of(r.method))).second) << r.path << " is registered twice";
    const auto published = described();
    EXPECT_GE(published.size(), 40u) << "the description was read";
    for (const auto& [path, method] : registered)
        EXPECT_TRUE(published.contains({path, method})) << method << " " << path << " is not described";
    for (const auto& [path, method] : published)
        EXPECT_TRUE(registered.contains({path, method})) << method << " " << path << " is described but not served";
}

TEST(OpenApi, RoutesThatTakeABodyAreDescribedSo) {
    // requestBody is at six spaces below its method.
    std::set<std::pair<std::string, std::string>> with_body;
    std::string path, method;
    for (const auto& line : lines_of_description()) {
        const auto indent = indent_of(line);
        if (indent == 2 && line.ends_with(':')) path = line.substr(2, line.size() - 3);
        if (indent == 4 && line.ends_with(':')) method = line.substr(4, line.size() - 5);
        if (line == "      requestBody:") with_body.emplace(path, method);
    }
    EXPECT_GE(with_body.size(), 40u) << "the description was read";
    for (const auto& r : all_routes()) {
        std::string low(name_of(r.method));
        for (auto& c : low)
            c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
        EXPECT_EQ(with_body.contains({std::string(r.path), low}), r.takes != Route::Takes::nothing) << low << " " << r.path;
    }
}

/// One value at six spaces below each method, by path and method; empty if it is missing.
std::map<std::pair<std::string, std::string>, std::string> published_at_each(const std::string& key) {
    std::map<std::pair<std::string, std::string>, std::string> out;
    std::pair<std::string, std::string> at;
    bool in_paths = false, in_method = false;
    for (const auto& line : lines_of_description()) {
        const auto indent = indent_of(line);
        if (indent == std::string::npos) continue;
        if (indent == 0) in_paths = line == "paths:";
        if (!in_paths) continue;
        if (indent == 2) at.first = line.substr(2, line.size() - 3);
        if (indent == 2 || indent == 4) in_method = indent == 4 && line != "    parameters:";
        if (indent == 4 && in_method) {
            at.second = line.substr(4, line.size() - 5);
            out[at];
        }
        if (indent == 6 && in_method && line.starts_with("      " + key + ": ")) out[at] = line.substr(8 + key.size());
    }
    return out;
}
std::pair<std::string, std::string> place_of(const Route& r) {
    std::string low(name_of(r.method));
    for (auto& c : low)
        c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return {std::string(r.path), low};
}

TEST(OpenApi, QueriesAreThoseOfTheDescriptionInBothDirections) {
    // A parameter is a list entry of an operation: "- name: x" with "in: query" below it, or a reference to one of the components, which
    // are at four spaces with their name at six.
    std::map<std::string, std::string> shared;
    std::map<std::pair<std::string, std::string>, std::set<std::string>> published;
    std::pair<std::string, std::string> at;
    std::string section, kind, component, name;
    for (const auto& line : lines_of_description()) {
        const auto indent = indent_of(line);
        if (indent == std::string::npos) continue;
        const std::string text = line.substr(indent);
        if (indent == 0) section = text;
        if (section == "components:") {
            if (indent == 2) kind = text;
            if (kind != "parameters:") continue;
            if (indent == 4) component = text.substr(0, text.size() - 1);
            if (text.starts_with("name: ")) name = text.substr(6);
            if (text == "in: query") shared[component] = name;
        }
    }
    for (const auto& line : lines_of_description()) {
        const auto indent = indent_of(line);
        if (indent == std::string::npos) continue;
        const std::string text = line.substr(indent);
        if (indent == 0) section = text;
        if (section != "paths:") continue;
        if (indent == 2) at.first = text.substr(0, text.size() - 1);
        if (indent == 4) at.second = text.substr(0, text.size() - 1);
        if (text.starts_with("- name: ")) name = text.substr(8);
        if (text == "in: query") published[at].insert(name);
        if (constexpr std::string_view head = "- {$ref: '#/components/parameters/"; indent == 8 && text.starts_with(head)) {
            const auto it = shared.find(text.substr(head.size(), text.size() - head.size() - 2));
            if (it != shared.end()) published[at].insert(it->second);
        }
    }
    EXPECT_GE(published.size(), 20u) << "the description was read";
    for (const auto& r : all_routes()) {
        std::set<std::string> taken;
        std::stringstream words{std::string(r.query)};
        for (std::string word; words >> word;)
            EXPECT_TRUE(taken.insert(word).second) << r.path << " has " << word << " twice";
        EXPECT_EQ(taken, published[place_of(r)]) << name_of(r.method) << " " << r.path;
    }
}

TEST(OpenApi, EveryOperationStatesTheRoleThatTheProgramAsksFor) {
    const auto published = published_at_each("x-role");
    EXPECT_EQ(published.size(), all_routes().size());
    for (const auto& [at, role] : published)
        EXPECT_TRUE(role_named(role)) << at.second << " " << at.first << " states no role: " << role;
    for (const auto& r : all_routes()) {
        const auto it = published.find(place_of(r));
        ASSERT_NE(it, published.end()) << r.path;
        EXPECT_EQ(it->second, name_of(r.needed())) << it->first.second << " " << r.path;
    }
}

TEST(OpenApi, EveryOperationStatesItsSecurity) {
    // A rule of the usual linters (security-defined): one for all, and none where no sign-in is necessary.
    const auto lines = lines_of_description();
    EXPECT_NE(std::ranges::find(lines, "security: [{session: []}, {token: []}, {}]"), lines.end());
    for (const auto* scheme : {"    session: {type: apiKey,", "    token: {type: http,"})
        EXPECT_TRUE(std::ranges::any_of(lines, [&](const std::string& l) { return l.starts_with(scheme); })) << scheme;
    const auto stated = published_at_each("security"), roles = published_at_each("x-role");
    for (const auto& [at, role] : roles) {
        const auto it = stated.find(at);
        EXPECT_EQ(it == stated.end() ? "" : it->second, role == "none" ? "[]" : "") << at.second << " " << at.first;
    }
    EXPECT_EQ(std::ranges::find(lines, "    Options:"), lines.end()) << "a name that client generators use themselves";
}

TEST(OpenApi, VersionIsWhatToolsUnderstand) {
    const auto lines = lines_of_description();
    EXPECT_NE(std::ranges::find(lines, "openapi: 3.0.3"), lines.end());
}

class OpenApiDocuments : public HttpTest {
protected:
    static void expect_required(const json::value& document, const std::string& schema) {
        std::set<std::string> required;
        required_of(schema, required);
        EXPECT_FALSE(required.empty()) << schema;
        ASSERT_TRUE(document.is_object()) << schema;
        for (const auto& member : required)
            EXPECT_TRUE(document.get_object().contains(member)) << schema << "." << member << " is required but not there";
    }
};

TEST_F(OpenApiDocuments, HaveTheRequiredMembers) {
    gateway.set_picture("feeder", standing(3200));
    gateway.hands[gateway.drive("feeder")] = {{"stall", false, true, "held"}};
    gateway.tell(event("x", "feeder"));
    TraceEntry e;
    e.sequence = 1;
    gateway.traces[gateway.line("can0")] = {e};
    gateway.line_states[gateway.line("can0")].has_twin_bus = true;

    expect_required(call("GET", "/api/v1/about").json, "About");
    expect_required(call("GET", "/api/v1/families/demo").json, "Family");
    expect_required(call("GET", "/api/v1/families/demo/specimens/17").json, "Specimen");
    expect_required(call("GET", "/api/v1/families/demo/parameters").array()[0], "Parameter");
    expect_required(call("GET", "/api/v1/families/demo/commands").array()[0], "CatalogueCommand");
    expect_required(call("GET", "/api/v1/families/demo/errors").array()[0], "ErrorCode");
    expect_required(call("GET", "/api/v1/axes/feeder").json, "Axis");
    expect_required(call("GET", "/api/v1/axes/slide").json, "Axis");
    expect_required(call("GET", "/api/v1/drives/feeder").json, "Drive");
    const auto line = call("GET", "/api/v1/lines/can0").json;
    expect_required(line, "Line");
    expect_required(line.at("status"), "LineStatus");
    expect_required(line.at("status").at("twin"), "LineStatus");
    expect_required(line.at("status").at("counters"), "LineCounters");
    expect_required(call("GET", "/api/v1/drives/feeder").json.at("status"), "DriveStatus");
    expect_required(call("GET", "/api/v1/drives/feeder/hand?describe=1").array()[0], "HandItem");
    expect_required(call("GET", "/api/v1/events").array()[0], "Event");
    expect_required(call("GET", "/api/v1/lines/can0/trace").json, "Trace");
    expect_required(call("GET", "/api/v1/lines/can0/trace").json.at("frames").get_array()[0], "Frame");
    expect_required(call("GET", "/api/v1/axes/feeder/parameters").array()[0], "AxisParameter");
    expect_required(call("PUT", "/api/v1/site?dry_run=1", "{\"x\":1}").json, "SiteChange");
    expect_required(call("PUT", "/api/v1/site?dry_run=1", "{\"x\":1}").json.at("faults").get_array()[0], "Fault");
    expect_required(call("GET", "/healthz").json, "Health");
    expect_required(call("GET", "/readyz").json, "Ready");
    gateway.missing = {"x"};
    expect_required(call("GET", "/readyz").json, "NotReady");
    expect_required(call("GET", "/api/v1/none").json, "Problem");
    gateway.at_once = [](const Command&) { return good_result(); };
    expect_required(call("POST", "/api/v1/axes/feeder/commands", R"({"command":"enable"})").json, "CommandAnswer");
    expect_required(call("POST", "/api/v1/drives/feeder/native", R"({"send":"x"})").json, "NativeReply");
}

TEST_F(OpenApiDocuments, ReadOnlyAxisMembersAreThoseOfTheDescription) {
    std::set<std::string> required;
    required_of("AxisState", required);
    required.insert("age_ms");
    for (const auto& member : required)
        EXPECT_TRUE(is_document_member(member)) << member;
    // The description makes these two optional for gateways that do not know them.
    required.insert({"authority_holder", "authority_until"});
    for (const auto& row : axis_point_table) {
        if (row.document != PointInDocument::no) {
            EXPECT_TRUE(required.contains(std::string(row.name))) << row.name << " is told, and the description has it not";
        }
    }
    for (const auto* member : {"name", "drive", "channel", "number", "unit", "increments_per_unit", "position_min", "position_max",
                               "velocity_max", "acceleration_max"}) {
        EXPECT_FALSE(is_document_member(member)) << member;
    }
}
}  // namespace
}  // namespace axisgate::http::test
