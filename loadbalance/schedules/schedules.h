// The functions behind the table of schedules, one file each.
#pragma once

#include "loadbalance/schedule.h"

namespace delray::loadbalance::internal {

// Without messages: every rank knows its tasks from the start.
//
// static: rank k does the consecutive tasks from count * k / ranks on.
RankReport static_schedule(comm::Communicator& communicator, const TaskGrid& tasks,
                           const ScheduleOptions& options, TaskFunction work);
// interlaced: column i of row j goes to rank (i + j) modulo ranks.
RankReport interlaced_schedule(comm::Communicator& communicator, const TaskGrid& tasks,
                               const ScheduleOptions& options, TaskFunction work);
// random: the tasks are shuffled, the same way on every rank, and assigned in turn. O(tasks).
RankReport random_schedule(comm::Communicator& communicator, const TaskGrid& tasks,
                           const ScheduleOptions& options, TaskFunction work);

// Master and slaves (Badouel et al. 1990): rank 0 hands a batch of consecutive tasks to every rank,
// and another whenever one asks. Two messages for each batch, all through rank 0.
RankReport demand(comm::Communicator& communicator, const TaskGrid& tasks,
                  const ScheduleOptions& options, TaskFunction work);

// Demand with batches of share * rest / ranks tasks, in whole rows of the grid as long as a batch
// has one, so that they get smaller as the work proceeds (Pandzic et al. 1995). O(ranks log(rows /
// ranks)) batches.
RankReport guided(comm::Communicator& communicator, const TaskGrid& tasks,
                  const ScheduleOptions& options, TaskFunction work);

// Masters of masters (Green and Paddon 1990): the ranks are a tree, rank k below rank
// (k - 1) / fan_out, and each asks the one above it for what those below it need, a batch for every
// rank that works there. No rank hears from more than fan_out others.
RankReport hierarchical(comm::Communicator& communicator, const TaskGrid& tasks,
                        const ScheduleOptions& options, TaskFunction work);

// Work stealing (as Heirich and Arvo 1997 describe it as general): every rank begins with a static
// share. One that has none left asks all others for their load, the tasks that wait; then it takes,
// from those above the mean, in proportion to what they have above it, as many as the mean and at
// least one, and begins anew when those are done. It gives up where nobody has any. A rank that
// is busy with a task replies after it. 2 (ranks - 1) messages whenever a rank runs dry, so the
// number of messages is quadratic in the ranks by definition.
RankReport stealing(comm::Communicator& communicator, const TaskGrid& tasks,
                    const ScheduleOptions& options, TaskFunction work);

// Half of the rest (Ellsworth 1994): the same, but a rank that has none left takes half of what
// waits at the rank with most when that is asked, so that ranks that ask it at the same time do not
// take everything together.
RankReport half_stealing(comm::Communicator& communicator, const TaskGrid& tasks,
                         const ScheduleOptions& options, TaskFunction work);

// Stealing from neighbours in the hypercube (Heirich and Arvo 1997): a rank that has few tasks left
// asks those whose numbers differ from its own in one bit, and again when it has none. They release
// half of what they have more; those that have nothing to release remember it and share what they
// get later, so that work spreads over any distance (lifelines: Saraswat et al. 2011). 2 log(ranks)
// messages each time.
RankReport neighbour_stealing(comm::Communicator& communicator, const TaskGrid& tasks,
                              const ScheduleOptions& options, TaskFunction work);

// Stealing of pending rays (Badouel et al. 1990; Heirich and Arvo 1997): of work that is divisible
// loads are units that wait, and units of tasks that are begun move as tasks do. Whom a rank asks
// is as with `stealing` and with `neighbour-stealing`, which other work goes by.
RankReport ray_stealing(comm::Communicator& communicator, const TaskGrid& tasks,
                        const ScheduleOptions& options, TaskFunction work);
RankReport ray_neighbours(comm::Communicator& communicator, const TaskGrid& tasks,
                          const ScheduleOptions& options, TaskFunction work);

}  // namespace delray::loadbalance::internal
