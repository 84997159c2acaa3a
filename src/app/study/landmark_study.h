#pragma once

#include "app/study/study.h"

namespace patrol::app {

/// Paper 000, table 1: FastSLAM against its swarm variants on a round course, and on one that is not round.
Study circle_study();
Study noncircular_study();

/// Paper 001, table 3: a car on a course of 15 waypoints among 31 landmarks.
Study campus_study();

}  // namespace patrol::app
