#pragma once

#include <stdexcept>
#include <string>

#include <fmt/format.h>

#include "importer/site/imported_site.h"

/// Elements of synthetic SDF worlds for the tests.
namespace patrol::importer::sdf_text {

/// World with the elements from line 3 on.
inline std::string world(const std::string& elements, const std::string& version = "1.7") {
  return fmt::format("<?xml version=\"1.0\"?>\n<sdf version=\"{}\"><world name=\"w\">\n{}\n</world></sdf>\n", version,
                     elements);
}

inline std::string model(const std::string& name, const std::string& link, const std::string& pose = "0 0 0 0 0 0") {
  return fmt::format("<model name=\"{}\"><static>true</static><pose>{}</pose><link name=\"link\">{}</link></model>\n",
                     name, pose, link);
}

inline std::string visual(const std::string& geometry, const std::string& more = "") {
  return fmt::format("<visual name=\"visual\"><geometry>{}</geometry>{}</visual>", geometry, more);
}

inline std::string collision(const std::string& geometry) {
  return fmt::format("<collision name=\"collision\"><geometry>{}</geometry></collision>", geometry);
}

const std::string kBox = "<box><size>1 2 3</size></box>";

inline const SiteShape& shape_of(const ImportedSite& site, const std::string& name) {
  for (const SiteShape& shape : site.shapes) {
    if (shape.name == name) return shape;
  }
  throw std::runtime_error("no shape " + name);
}

inline std::string link(const std::string& shapes) { return "<link name=\"link\">" + shapes + "</link>"; }

}  // namespace patrol::importer::sdf_text
