// Each step begins in the answer of the previous one. If a command is answered inside submit, a loop continues instead of a deeper call.
#include "gateway/services/parameters/axis_jobs.hpp"

#include <fmt/core.h>

namespace axisgate {

std::string why_not_written(const AxisPicture& p) { return (p.flags & flag_moving) != 0 ? "the axis moves: stop it" : ""; }

struct AxisJob : std::enable_shared_from_this<AxisJob> {
    AxisPort& axes;
    std::shared_ptr<AxisJobs> jobs;
    std::shared_ptr<AxisJobs::Progress> progress;
    std::string axis;
    AxisId id;
    std::vector<JobPoint> points;
    bool write;
    Origin origin;
    std::function<void(JobEnd)> then;
    JobEnd end;
    bool stepping = false, answered = false;

    AxisJob(AxisPort& a, AxisId i, bool w, Origin o) : axes(a), id(i), write(w), origin(std::move(o)) {}

    void finish() {
        progress->state = end.broken_off.empty() ? AxisJobs::State::done : AxisJobs::State::failed;
        progress->text = end.broken_off;
        if (end.broken_off.empty() && !end.failed.empty())
            progress->text = fmt::format("{} of {} were refused", end.failed.size(), points.size());
        auto done = std::move(then);
        done(std::move(end));
    }
    void take(const JobPoint& p, const Result& r) {
        if (good(r)) {
            end.values.push_back({p.id, known(r.value) ? r.value : p.value});
            return;
        }
        const std::string why = r.text.empty() ? std::string(name_of(r.reason)) : r.text;
        if (r.reason == Reason::no_answer || r.reason == Reason::line_down || r.reason == Reason::busy) {
            end.silent = true;
            end.broken_off = fmt::format("{} of {} parameters were {} when {} was not answered: {}", progress->done, points.size(),
                                         write ? "written" : "read", p.id, why);
            return;
        }
        if (r.reason == Reason::wrong_state || r.reason == Reason::authority || r.reason == Reason::internal) {
            if (write) {
                end.broken_off =
                    fmt::format("{} of {} parameters were written when {} was refused: {}", progress->done, points.size(), p.id, why);
                return;
            }
        }
        end.failed.push_back({p.id, why});
    }
    /// A command may be answered inside submit: then the loop runs once more instead of a deeper call.
    void step() {
        stepping = true;
        for (;;) {
            if (!end.broken_off.empty() || progress->done == points.size()) break;
            const JobPoint& p = points[progress->done];
            if (const auto why = write ? why_not_written(axes.picture(id)) : std::string(); !why.empty()) {
                end.broken_off = fmt::format("{} of {} parameters were written, then {}", progress->done, points.size(), why);
                break;
            }
            Command command;
            command.axis = id;
            command.origin = origin;
            if (write)
                command.body = WriteParameter{p.point, p.value};
            else
                command.body = ReadParameter{p.point};
            answered = false;
            axes.submit(std::move(command), [self = shared_from_this()](const Result& r) {
                self->take(self->points[self->progress->done], r);
                if (self->end.broken_off.empty()) ++self->progress->done;
                self->answered = true;
                if (!self->stepping) self->step();
            });
            if (!answered) {
                stepping = false;
                return;
            }
        }
        stepping = false;
        finish();
    }
};

const AxisJobs::Progress* AxisJobs::of(const std::string& axis) const {
    const auto it = list_.find(axis);
    return it == list_.end() ? nullptr : it->second.get();
}

bool AxisJobs::start(const std::shared_ptr<AxisJobs>& jobs, AxisPort& axes, const std::string& axis, AxisId id,
                     std::vector<JobPoint> points, bool write, Origin origin, std::function<void(JobEnd)> then) {
    if (const auto* p = jobs->of(axis); p && p->state == State::running) return false;
    if (jobs->list_.size() >= most_kept) std::erase_if(jobs->list_, [](const auto& x) { return x.second->state != State::running; });
    auto job = std::make_shared<AxisJob>(axes, id, write, std::move(origin));
    job->jobs = jobs;
    job->axis = axis;
    job->points = std::move(points);
    job->then = std::move(then);
    job->progress = std::make_shared<Progress>();
    job->progress->kind = write ? "write" : "read";
    job->progress->of = job->points.size();
    jobs->list_[axis] = job->progress;
    job->step();
    return true;
}

}  // namespace axisgate
