#include "app/mapping/neighbour_model.h"

#include "app/scenario.h"
#include "io/adaboost_json.h"
#include "slam/submaps/pair_features.h"

namespace patrol::app {

BoostedStumps neighbours_for(const slam::MapperSettings& settings) {
  if (settings.method != "submap_rbpf") return {};
  return io::load_boosted_stumps(find_data_root("") / kNeighbourModel, slam::pair_feature_names());
}

}  // namespace patrol::app
