#pragma once

#include "studies/study.h"

namespace patrol::studies {

/// Studies of [Wu25, table 1]: FastSLAM compared with its swarm variants, on a circular and on a noncircular course.
Study circle_study();
Study noncircular_study();

/// Study of [Cui21, table 3]: a car on a course of 15 waypoints among 31 landmarks.
Study campus_study();

}  // namespace patrol::studies
