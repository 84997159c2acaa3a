#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "render/report/blocks.h"

namespace patrol::app {

/// Something measured of every variant with every seed.
struct StudyFigure {
  std::string name;
  std::string unit;               ///< empty: a plain number
  bool is_compared = false;       ///< with what was published, and with the variant's reference
  bool is_of_the_clock = false;   ///< processor time: another one each time
};

/// A method in a world.
struct StudyVariant {
  std::string world;
  std::string method;
  int particles = 0;                                ///< 0: it has none
  std::size_t reference = 0;                        ///< variant that it is compared with, pair by pair
  std::vector<std::optional<double>> published{};   ///< [figure]; shorter, or nothing: the paper says nothing
};

/// [variant][figure] of one seed; not a number: it has no such figure.
using StudySample = std::vector<std::vector<double>>;

/// An experiment of a paper: what is run, what is measured, and what was published.
struct Study {
  std::string name;
  std::string title;
  std::string source;      ///< which paper, which table
  std::string conditions;  ///< what the paper leaves open, and what is taken here
  int default_seeds = 20;
  std::string compared_with = "the first";  ///< each variant's reference, for people
  std::vector<StudyFigure> figures{};
  std::vector<StudyVariant> variants{};
  std::function<StudySample(std::uint64_t seed)> run{};
  std::function<std::vector<render::Section>(std::uint64_t seed)> illustrate{};  ///< of one seed: tracks, maps, errors over time
};

/// By name. Throws InputError that names the known ones.
Study make_study(const std::string& name);
std::vector<std::string> study_names();

}  // namespace patrol::app
