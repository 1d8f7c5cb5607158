// The parts of the fakes that are compiled once: construction, destruction, the site.
#include "tests/unit/http/fake_gateway.hpp"

namespace axisgate::http::test {

FakeSite::FakeSite(std::string_view site_text) {
    std::vector<std::string> faults;
    catalogue = *Catalogue::parse(catalogue_text, faults);
    family.name = "demo";
    family.check_address = check_demo_address;
    family.make_decoder = make_demo_decoder;
    family.factory_address = "5";
    family.default_bit_rate = 57600;
    family.default_format = "8N1";
    family.uses_can = true;
    family.uses_bytes = true;
    families_.entries.push_back({&family, &catalogue});
    put_site(site_text);
}

FakeSite::~FakeSite() = default;

FakeGateway::FakeGateway(std::string_view site_text)
    : FakeSite(site_text),
      FakeAxes(static_cast<FakeSite&>(*this)),
      FakeEvents(static_cast<const FakeClock&>(*this)),
      FakeStage(static_cast<FakeSite&>(*this), static_cast<const FakeClock&>(*this)),
      FakeModbus(FakeSnapshots::keep_fault),
      FakeBackup(FakeSnapshots::keep_fault) {}

FakeGateway::~FakeGateway() = default;

void FakeSite::put_site(std::string_view text) {
    std::vector<SiteFault> faults;
    auto site = parse_site(boost::json::parse(text), families_, faults);
    if (!site) throw std::logic_error("the test's site is wrong: " + faults.front().text);
    put_site(std::move(*site));
}

void FakeSite::put_site(Site site) {
    auto state = std::make_shared<SiteState>();
    state->revision = site_ ? site_->revision + 1 : 1;
    for (const auto& l : site.lines)
        state->line_ids.push_back(LineId{id_of("line " + l.name)});
    for (const auto& d : site.drives)
        state->drive_ids.push_back(DriveId{id_of("drive " + d.name)});
    for (const auto& a : site.axes)
        state->axis_ids.push_back(AxisId{id_of("axis " + a.name)});
    state->site = std::move(site);
    site_ = state;
    const auto all = site_listeners;
    for (auto* l : all)
        l->on_site(site_);
}

}  // namespace axisgate::http::test
