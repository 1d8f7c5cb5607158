// All ports of tests of the HTTP door in one: the doubles of each topic, put together around a small site.
// In: what the test sets. Out: what the door asked. Never has a thread or a clock: now_ns is set by the test.
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
    ~FakeGateway() override;  ///< in fake_gateway.cpp, and with it the tables of virtual functions: they are compiled once
    Ports ports() { return *this; }
};

}  // namespace axisgate::http::test
