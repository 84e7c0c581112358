// The families of algorithms that options choose from, for --list.
#pragma once

namespace delray::apps {

void list_strategies();
void list_partitions();
void list_schemes();
void list_codecs();
void list_integrators();
void list_distributions();
void list_schedules();
void list_methods();
// The choices that methods leave: location, split, order, deadlock strategy.
void list_method_options();
// How ranks share one triangulation.
void list_distributed_methods();
void list_criteria();
void list_refinements();
void list_networks();
// The meanings of colours (--color-by), and tone curves.
void list_colours();

}  // namespace delray::apps
