// Constructs the parts of the engine once and connects them: each part gets the others that its constructor names, and does not know this
// file.
#pragma once

#include "gateway/engine/clients.hpp"
#include "gateway/engine/command_authority.hpp"
#include "gateway/engine/commands.hpp"
#include "gateway/engine/fast_look.hpp"
#include "gateway/engine/loss_of_command.hpp"
#include "gateway/engine/machine.hpp"
#include "gateway/engine/motions.hpp"
#include "gateway/engine/orders.hpp"
#include "gateway/engine/presences.hpp"
#include "gateway/engine/publisher.hpp"
#include "gateway/engine/routing.hpp"
#include "gateway/engine/scans.hpp"
#include "gateway/engine/site_change.hpp"
#include "gateway/engine/site_in_force.hpp"
#include "gateway/engine/speakers.hpp"
#include "gateway/engine/streams.hpp"
#include "gateway/engine/supervisor.hpp"
#include "gateway/engine/twins.hpp"

namespace axisgate {

struct Engine::Parts {
    Parts(Families families, EngineHost& host, Image& image, std::size_t trace_frames)
        : machine(std::move(families), image),
          publisher(machine, host),
          routing(machine, publisher, presences, orders, clients, motions, supervisor, loss, streams),
          speakers(machine, host, routing, trace_frames),
          twins(machine, host, publisher),
          presences(machine, pending, publisher, routing, speakers, twins, clients, streams, motions),
          clients(machine, pending, publisher),
          orders(machine, pending, host, publisher, routing, twins, presences, clients, motions, streams, loss),
          motions(publisher, orders, clients, streams, loss),
          supervisor(publisher, orders),
          authority(machine, publisher),
          loss(machine, pending, host, publisher, orders, streams),
          streams(machine, publisher, routing, orders, authority, loss, motions),
          commands(machine, pending, publisher, twins, orders, clients, motions, authority),
          scans(machine, publisher, speakers),
          looks(machine, publisher, speakers),
          site_in_force(machine, pending, publisher, speakers, twins, presences, clients, scans),
          site_change(machine, pending, publisher, orders, site_in_force) {}

    engine::Machine machine;
    engine::Pending pending;
    engine::Publisher publisher;
    engine::Routing routing;
    engine::Speakers speakers;
    engine::Twins twins;
    engine::Presences presences;
    engine::Clients clients;
    engine::Orders orders;
    engine::Motions motions;
    engine::Supervisor supervisor;
    engine::CommandAuthority authority;
    engine::LossOfCommand loss;
    engine::Streams streams;
    engine::Commands commands;
    engine::Scans scans;
    engine::FastLook looks;
    engine::SiteInForce site_in_force;
    engine::SiteChange site_change;
};

}  // namespace axisgate
