// The families of algorithms that options choose from: a heading for each, with its option.
#include "apps/families.h"

#include "apps/input/colour_by.h"
#include "apps/options/list.h"
#include "comm/network.h"
#include "composite/codec.h"
#include "composite/scheme.h"
#include "delaunay/distributed.h"
#include "delaunay/improve.h"
#include "delaunay/methods.h"
#include "delaunay/refine.h"
#include "image/tone.h"
#include "loadbalance/partition.h"
#include "loadbalance/schedule.h"
#include "raster/strategies.h"
#include "raytrace/distribution.h"
#include "raytrace/integrator.h"

namespace delray::apps {

void list_strategies() {
  print_table("Strategies: how ranks share the rasterizer's work (--strategy)",
              raster::strategies());
}

void list_partitions() {
  print_table("Partitions of the screen among ranks (--partition)", loadbalance::partitioners());
}

void list_schemes() {
  print_table("Compositing schemes: how the images of all ranks become one (--compose)",
              composite::schemes());
}

void list_codecs() { print_table("Pixel encodings between ranks (--codec)", composite::codecs()); }

void list_integrators() {
  print_table("Integrators: what the ray tracer computes (--integrator)", raytrace::integrators());
}

void list_distributions() {
  print_table("Distributions of the scene among ranks (--data)", raytrace::distributions());
}

void list_schedules() {
  print_table("Schedules: how ranks share the blocks of a picture (--schedule)",
              loadbalance::schedules());
}

void list_method_options() {
  print_table("Locations: how the simplex of a new point is found (--location)",
              delaunay::locations());
  print_table("Splits: which thread inserts which points (--split)", delaunay::splits());
  print_table("Orders of insertion (--order)", delaunay::orders());
  print_table("Deadlock strategies of the optimistic method (--deadlocks)",
              delaunay::deadlock_strategies());
  print_table("Locks: what threads lock simplices by, or their critical section (--locks)",
              delaunay::lock_kinds());
  print_table("Times of unlocking: when threads unlock simplices (--unlock)",
              delaunay::unlock_times());
}

void list_methods() { print_table("Methods of triangulation (--method)", delaunay::methods()); }

void list_distributed_methods() {
  print_table("Distributed methods: how ranks share one triangulation (--distributed)",
              delaunay::distributed_methods());
}

void list_criteria() {
  print_table("Criteria of flips that improve a mesh (--criterion)", delaunay::criteria());
}

void list_refinements() {
  print_table("Refinements: how points are added (--refinement)", delaunay::refinement_methods());
}

void list_colours() {
  print_table("Colours: what they show (--color-by)", colour_bys());
  print_table("Tone curves from light to the screen (--tone)", image::tone_curves());
}

void list_networks() { print_table("Networks to predict times for", comm::networks()); }

}  // namespace delray::apps
