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
void list_networks();

}  // namespace delray::apps
