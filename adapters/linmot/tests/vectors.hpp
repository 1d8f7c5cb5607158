// Reads vectors.txt, the printed telegrams of the family, as cases in order. A line with another form is a fault of the test.
#pragma once

#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

namespace axisgate::linmot::test {

struct Exchange {
    std::vector<std::uint8_t> request, answer;
    std::map<std::string, std::int64_t> fields;
};
struct Case {
    std::string name;
    std::vector<std::string> given, compare;
    std::vector<Exchange> exchanges;
};

inline std::vector<std::uint8_t> bytes_of(const std::string& text) {
    std::vector<std::uint8_t> bytes;
    std::istringstream in(text);
    for (std::string pair; in >> pair;)
        bytes.push_back(static_cast<std::uint8_t>(std::stoul(pair, nullptr, 16)));
    return bytes;
}

inline const std::vector<Case>& cases() {
    static const std::vector<Case> all = [] {
        std::vector<Case> list;
        std::ifstream in(std::string(AXISGATE_SOURCE_DIR) + "/adapters/linmot/vectors.txt");
        for (std::string line; std::getline(in, line);) {
            line = line.substr(0, line.find('#'));
            std::istringstream words(line);
            std::string key;
            if (!(words >> key)) continue;
            std::string rest;
            std::getline(words, rest);
            std::istringstream args(rest);
            if (key == "case") {
                list.emplace_back();
                args >> list.back().name;
            } else if (key == "given" || key == "compare") {
                for (std::string w; args >> w;)
                    (key == "given" ? list.back().given : list.back().compare).push_back(w);
            } else if (key == ">") {
                list.back().exchanges.push_back({bytes_of(rest), {}, {}});
            } else if (key == "<") {
                list.back().exchanges.back().answer = bytes_of(rest);
            } else if (key == "fields") {
                for (std::string w; args >> w;)
                    list.back().exchanges.back().fields[w.substr(0, w.find('='))] = std::stoll(w.substr(w.find('=') + 1));
            } else {
                ADD_FAILURE() << "vectors.txt: " << line;
            }
        }
        return list;
    }();
    return all;
}

}  // namespace axisgate::linmot::test
