#!/usr/bin/env python3
"""Stock MuJoCo loads the street, steps it, and finds in it what the brief names.

usage: street_world_test.py STREET_XML
"""
import sys
import unittest

import mujoco
import numpy as np

STREET_XML = sys.argv[1]
EYE_AND_LIDAR, EYE_ONLY, LIDAR_ONLY, FEET_ONLY = range(4)


class Street(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.model = mujoco.MjModel.from_xml_path(STREET_XML)

    def setUp(self):
        self.data = mujoco.MjData(self.model)
        mujoco.mj_forward(self.model, self.data)

    def ground_at(self, x, y):
        """Height of what a ray straight down from 1.5 m meets; it must be something that feet collide with."""
        seen_or_walked_on = np.array([1, 0, 0, 1, 0, 0], np.uint8)
        geom = np.array([-1], np.int32)
        down = np.array([0.0, 0.0, -1.0])
        distance = mujoco.mj_ray(self.model, self.data, np.array([x, y, 1.5]), down, seen_or_walked_on, 1, -1, geom)
        self.assertGreaterEqual(distance, 0.0, f"nothing to stand on at {x}, {y}")
        self.assertTrue(self.model.geom_contype[geom[0]] & 1, f"feet fall through {self.model.geom(geom[0]).name} at {x}, {y}")
        return 1.5 - distance

    def test_steps_a_second_without_a_warning(self):
        mujoco.mj_step(self.model, self.data, round(1.0 / self.model.opt.timestep))
        self.assertEqual([int(warning.number) for warning in self.data.warning], [0] * len(self.data.warning))
        self.assertTrue(np.isfinite(self.data.xpos).all())

    def test_physics_step_is_two_milliseconds(self):
        self.assertEqual(self.model.opt.timestep, 0.002)

    def test_two_pedestrians_with_legs_and_a_car_are_moved_by_mocap(self):
        bodies = {self.model.body(i).name for i in range(self.model.nbody)}
        for name in ("pedestrian_1", "pedestrian_2", "pedestrian_1_thigh_left", "pedestrian_2_shank_right", "car_1"):
            self.assertIn(name, bodies)
            self.assertGreaterEqual(int(self.model.body(name).mocapid[0]), 0, name)

    def test_boxes_and_well_stand_surveyed_within_the_block(self):
        for name in ("regulator_box_1", "regulator_box_2", "valve_well_3"):
            x, y, z = self.data.site(name).xpos
            self.assertTrue(0 < x < 60 and 0 < y < 100 and -0.5 < z < 3, name)

    def test_ground_carries_feet_everywhere_in_the_street(self):
        for x, y in [(11.0, 8.0), (11.0, 40.0), (11.0, 75.0), (30.0, 82.0), (50.0, 82.0)]:
            self.assertLess(abs(self.ground_at(x, y)), 0.3)

    def test_every_geom_has_a_group_that_says_who_meets_it(self):
        self.assertLessEqual(set(self.model.geom_group.tolist()), {EYE_AND_LIDAR, EYE_ONLY, LIDAR_ONLY, FEET_ONLY})
        eye_only = self.model.geom_group == EYE_ONLY
        self.assertTrue((self.model.geom_contype[eye_only] == 0).all(), "what only the eye sees must not be bumped into")

    def test_it_is_textured_and_lit(self):
        self.assertGreaterEqual(self.model.ntex, 10)
        self.assertGreaterEqual(self.model.nlight, 1)
        self.assertIn(int(mujoco.mjtTexture.mjTEXTURE_SKYBOX), self.model.tex_type.tolist())


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], "-v"])
