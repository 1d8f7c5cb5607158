// All fake ports in one, with a small site; the test sets their answers and reads the requests. There is no thread and no clock: the test
// sets now_ns.
#pragma once

#include "gateway/services/ports.hpp"
#include "tests/unit/http/fake_axes.hpp"
#include "tests/unit/http/fake_clock.hpp"
#include "tests/unit/http/fake_documents.hpp"
#include "tests/unit/http/fake_events.hpp"
#include "tests/unit/http/fake_lines.hpp"
#include "tests/unit/http/fake_rehearsal.hpp"
#include "tests/unit/http/fake_site.hpp"
#include "tests/unit/http/fake_stage.hpp"

namespace axisgate::http::test {

class FakeGateway final : public FakeClock,
                          public FakeStatus,
                          public FakeSite,
                          public FakeAxes,
                          public FakeParameters,
                          public FakeLines,
                          public FakeDrives,
                          public FakeEvents,
                          public FakeDescriptions,
                          public FakeDocuments,
                          public FakeSnapshots,
                          public FakeStage,
                          public FakeRegisters,
                          public FakeRehearsal,
                          public FakeFleet,
                          public FakeRecorder,
                          public FakeCaptures,
                          public FakeModbus,
                          public FakeConnections,
                          public FakeBackup {
public:
    explicit FakeGateway(std::string_view site_text = default_site);
    ~FakeGateway() override;  ///< in fake_gateway.cpp with the tables of virtual functions, so that they are compiled once
    Ports ports() { return *this; }
};

}  // namespace axisgate::http::test
