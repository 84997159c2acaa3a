#include "app/scenario/neighbor_model.h"

#include "core/named_table.h"
#include "io/json/adaboost_json.h"
#include "slam/methods/mapper.h"
#include "slam/submaps/pair_features.h"

namespace patrol::app {

bool needs_neighbor_model(const std::string& method) {
  return row_named(slam::mapping_methods(), method, "slam.method").needs_neighbor_model;
}

BoostedStumps load_neighbor_model(const std::string& method, const std::filesystem::path& data_root) {
  if (!needs_neighbor_model(method)) return {};
  return io::load_boosted_stumps(data_root / kNeighborModel, slam::pair_feature_names());
}

}  // namespace patrol::app
