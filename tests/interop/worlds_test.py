#!/usr/bin/env python3
"""Stock MuJoCo loads a world, steps it, and finds in it what the briefs name.

usage: worlds_test.py Street|Tunnel|Substation WORLD_XML
"""
import json
import pathlib
import sys
import unittest

import mujoco
import numpy as np

WORLD, XML = sys.argv[1], pathlib.Path(sys.argv[2])
EYE_AND_LIDAR, EYE_ONLY, LIDAR_ONLY, FEET_ONLY = range(4)
LIDAR_SEES = np.array([1, 0, 1, 0, 0, 0], np.uint8)
TOUCHABLE = np.array([1, 0, 1, 1, 0, 0], np.uint8)
IN_THE_WAY = np.array([1, 0, 0, 1, 0, 0], np.uint8)  # all but the tunnel's invert


class World:
    @classmethod
    def setUpClass(cls):
        cls.model = mujoco.MjModel.from_xml_path(str(XML))

    def setUp(self):
        self.data = mujoco.MjData(self.model)
        mujoco.mj_forward(self.model, self.data)

    def range(self, origin, direction, groups):
        """Distance and name of what a ray meets; infinity and '' where it meets nothing."""
        geom = np.array([-1], np.int32)
        distance = mujoco.mj_ray(self.model, self.data, np.array(origin, float), np.array(direction, float), groups, 1, -1, geom)
        return (np.inf, "") if distance < 0.0 else (distance, self.model.geom(geom[0]).name)

    def ground_at(self, x, y, eye=1.5):
        """Height of what a ray straight down meets; it must be something that feet and tracks collide with."""
        distance, name = self.range((x, y, eye), (0, 0, -1), TOUCHABLE)
        self.assertLess(distance, np.inf, f"nothing to stand on at {x}, {y}")
        self.assertTrue(self.model.geom(name).contype[0] & 1, f"feet fall through {name} at {x}, {y}")
        return eye - distance

    def assert_moved_by_mocap(self, names):
        bodies = {self.model.body(i).name for i in range(self.model.nbody)}
        for name in names:
            self.assertIn(name, bodies)
            self.assertGreaterEqual(int(self.model.body(name).mocapid[0]), 0, name)

    def test_steps_a_second_without_a_warning_or_a_contact(self):
        mujoco.mj_step(self.model, self.data, round(1.0 / self.model.opt.timestep))
        self.assertEqual([int(warning.number) for warning in self.data.warning], [0] * len(self.data.warning))
        self.assertTrue(np.isfinite(self.data.xpos).all())
        self.assertEqual(self.data.ncon, 0)

    def test_physics_step_is_two_milliseconds(self):
        self.assertEqual(self.model.opt.timestep, 0.002)

    def test_every_geom_has_a_group_that_says_who_meets_it(self):
        self.assertLessEqual(set(self.model.geom_group.tolist()), {EYE_AND_LIDAR, EYE_ONLY, LIDAR_ONLY, FEET_ONLY})
        eye_only = self.model.geom_group == EYE_ONLY
        self.assertTrue((self.model.geom_contype[eye_only] == 0).all(), "what only the eye sees must not be bumped into")

    def test_it_is_textured_and_lit(self):
        self.assertGreaterEqual(self.model.ntex, 10)
        self.assertGreaterEqual(self.model.nlight, 1)
        self.assertIn(int(mujoco.mjtTexture.mjTEXTURE_SKYBOX), self.model.tex_type.tolist())


class Street(World, unittest.TestCase):
    def test_two_pedestrians_with_legs_and_a_car_are_moved_by_mocap(self):
        self.assert_moved_by_mocap(("pedestrian_1", "pedestrian_2", "pedestrian_1_thigh_left", "pedestrian_2_shank_right", "car_1"))

    def test_boxes_and_well_stand_surveyed_within_the_block(self):
        for name in ("regulator_box_1", "regulator_box_2", "valve_well_3"):
            x, y, z = self.data.site(name).xpos
            self.assertTrue(0 < x < 60 and 0 < y < 100 and -0.5 < z < 3, name)

    def test_ground_carries_feet_everywhere_in_the_street(self):
        for x, y in [(11.0, 8.0), (11.0, 40.0), (11.0, 75.0), (30.0, 82.0), (50.0, 82.0)]:
            self.assertLess(abs(self.ground_at(x, y)), 0.3)


class Tunnel(World, unittest.TestCase):
    STRAIGHT = 80.0  # the tunnel runs along x so far

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.site = json.loads((XML.parent / "site.json").read_text())
        cls.drive = [waypoint["position"] for waypoint in json.loads((XML.parent / "drive.json").read_text())["waypoints"]]
        cls.goals = [waypoint["position"] for waypoint in json.loads((XML.parent / "drive.json").read_text())["waypoints"]
                     if "mark_heading_deg" in waypoint]

    def clearance(self, x, y, bearings=np.linspace(0.0, 2.0 * np.pi, 90, endpoint=False), heights=(0.12, 0.25, 0.55, 0.8)):
        """Way to the nearest thing at the robot's height; low ones count."""
        return min(self.range((x, y, z), (np.cos(b), np.sin(b), 0.0), IN_THE_WAY)[0] for z in heights for b in bearings)

    def test_two_workers_with_legs_and_a_dumper_are_moved_by_mocap(self):
        self.assert_moved_by_mocap(("worker_1", "worker_2", "worker_1_thigh_left", "worker_2_shank_right", "vehicle_1"))

    def test_it_is_about_11_metres_wide_8_high_and_160_long(self):
        wide = sum(self.range((46, 0, 2.5), (0, side, 0), LIDAR_SEES)[0] for side in (-1, 1))
        self.assertAlmostEqual(wide, 11.0, delta=0.02)
        crown = self.range((46, 0, 2.5), (0, 0, 1), LIDAR_SEES)[0] + 2.5
        self.assertAlmostEqual(crown, 8.0, delta=0.02)
        face_x = np.cos(0.2) * 400.0  # no more than a bound: the line bends by 0.205 rad in 82 m
        x = max(self.data.geom_xpos[i][0] + self.model.geom_rbound[i] for i in range(self.model.ngeom) if self.model.geom(i).name == "face")
        self.assertTrue(155.0 < x < face_x)

    def test_52_metres_of_straight_lining_look_the_same_to_a_lidar_from_everywhere(self):
        bearings = np.radians(np.concatenate([np.arange(45, 136, 5), np.arange(-135, -44, 5)]))

        def scan(x, z):
            return np.array([self.range((x, 0.0, z), (np.cos(b), np.sin(b), 0.0), LIDAR_SEES)[0] for b in bearings])
        for z in (0.4, 0.55, 0.7):
            first = scan(23.5, z)
            self.assertTrue((first < 8.0).all())
            for x in np.arange(24.5, 65.6, 1.0):  # and the beams reach 5.3 m further both ways
                np.testing.assert_allclose(scan(x, z), first, atol=1e-3)

    def test_the_lining_is_the_surveys_within_a_millimetre_from_the_first_ring_to_the_last(self):
        design = self.site["lining"]
        self.assertEqual([element["length"] for element in design["axis"]][0], self.STRAIGHT)
        self.assertEqual((design["first_ring"], design["ring_length"], design["rings"]), (0.0, 2.0, 50))
        radius = 1.0 / design["axis"][1]["curvature"]
        for s in (0.02, 1.3, 35.7, 61.1, 81.5, 83.1, 91.0):  # 83.1: not in the middle of a ring
            turn = max(s - self.STRAIGHT, 0.0) / radius
            x, y = min(s, self.STRAIGHT) + radius * np.sin(turn), radius * (1.0 - np.cos(turn))
            for clock in np.radians((-80, -50, -21, 8, 40, 77)):
                left = -np.sin(clock)
                direction = (-left * np.sin(turn), left * np.cos(turn), np.cos(clock))
                near = design["crown_radius"] - 0.05  # past what hangs there
                origin = np.array((x, y, design["crown_center"])) + near * np.array(direction)
                distance, name = self.range(origin, direction, LIDAR_SEES)
                self.assertEqual(name, "lining")
                self.assertAlmostEqual(near + distance, design["crown_radius"], delta=1e-3)

    def test_the_lanes_are_drivable_no_step_of_5_centimetres_in_a_metre(self):
        for y in (-2.2, 2.2):
            for across in (-0.35, 0.0, 0.35):  # under both tracks and between them
                height = np.array([self.ground_at(x, y + across, eye=0.3) for x in np.arange(20.0, 69.0, 0.1)])
                self.assertLess(np.abs(height).max(), 0.05)
                spread = [np.ptp(height[i:i + 11]) for i in range(len(height) - 11)]
                self.assertLess(max(spread), 0.05)
                self.assertGreater(max(spread), 0.005, "that is a floor, not an invert")

    def test_anchors_hang_where_the_survey_says_within_4_standard_errors_of_1_cm(self):
        surveyed = {anchor["number"]: np.array(anchor["position"]) for anchor in self.site["anchors"]}
        self.assertGreaterEqual(len(surveyed), 8)
        places = np.array([self.data.site(f"uwb_anchor_{number}").xpos for number in sorted(surveyed)])
        errors = places - np.array([surveyed[number] for number in sorted(surveyed)])
        self.assertLess(np.abs(errors).max(), 0.04)
        self.assertGreater(errors.std(), 0.005, "a survey has errors")
        self.assertLess(np.linalg.norm(np.diff(places[:, :2], axis=0), axis=1).max(), 24.0)
        self.assertTrue(((1.5 <= places[:, 2]) & (places[:, 2] <= 3.0)).all())

    def test_the_docked_robot_has_4_metres_behind_it_and_2_at_its_sides(self):
        x, y, _ = self.site["dock"]["position"]
        self.assertEqual(self.site["dock"]["orientation"], [0.0, 0.0, 1.0, 0.0])  # looks towards -x
        self.assertEqual(self.site["start"]["position"], self.site["dock"]["position"])
        behind = min(self.range((x, y + off, z), (1, 0, 0), IN_THE_WAY)[0] for off in (-0.4, 0.0, 0.4) for z in (0.1, 0.3, 0.6))
        self.assertGreater(behind - 0.5, 4.0)
        for side in (-1, 1):
            beside = min(self.range((x + off, y, z), (0, side, 0), IN_THE_WAY)[0] for off in (-0.5, 0.0, 0.5) for z in (0.1, 0.3, 0.6))
            self.assertGreater(beside - 0.35, 2.0)

    def test_the_post_has_the_surveyed_profile_at_every_height_a_lidar_may_have(self):
        x, y, _ = self.site["dock"]["position"]
        profile = np.array(self.site["dock"]["profile"])
        for across in np.arange(-0.40, 0.401, 0.02):
            expected = np.interp(across, profile[:, 1], profile[:, 0])
            for z in (0.4, 0.55, 0.7):  # the body looks towards -x, its left is towards -y
                self.assertAlmostEqual(self.range((x, y - across, z), (-1, 0, 0), LIDAR_SEES)[0], expected, delta=2e-3)

    def test_the_bridge_can_be_driven_over_at_15_degrees_at_most(self):
        heights, steps = [], 0.05
        a = (135.0 - self.STRAIGHT) / 400.0
        middle = np.array((self.STRAIGHT + (400.0 + 1.9) * np.sin(a), -1.9 + (400.0 + 1.9) * (1.0 - np.cos(a))))
        ahead, left = np.array((np.cos(a), np.sin(a))), np.array((-np.sin(a), np.cos(a)))
        for along in np.arange(-8.0, 8.0, steps):
            row = [self.ground_at(*(middle + along * ahead + across * left), eye=1.0) for across in (-1.3, 0.0, 1.3)]
            if abs(along) < 6.0:
                self.assertLess(np.ptp(row), 0.02)
            heights.append(row[1])
        self.assertTrue(0.5 <= max(heights) <= 0.7)
        self.assertLess(np.degrees(np.arctan(np.abs(np.diff(heights)).max() / steps)), 15.0)

    def test_the_drive_keeps_80_centimetres_from_everything_once_it_has_left_the_dock(self):
        for start, end in zip(self.drive, self.drive[1:]):
            for share in np.linspace(0.0, 1.0, 2 + int(np.hypot(*np.subtract(end, start)))):
                x, y = (1.0 - share) * np.array(start) + share * np.array(end)
                self.assertGreater(self.clearance(x, y), 0.8, f"at {x:.2f}, {y:.2f}")

    def test_something_stands_in_the_straight_way_to_each_goal(self):
        self.assertEqual(len(self.goals), 3)
        start = self.site["start"]["position"][:2]
        for origin, goal in zip([start] + self.goals, self.goals):
            way = np.subtract(goal, origin)
            length = np.hypot(*way)
            self.assertLess(self.range((*origin, 0.55), (*(way / length), 0.0), IN_THE_WAY)[0], length)


class Substation(World, unittest.TestCase):
    BAYS, BAY_WIDTH, PATH_Y = (20.5, 35.5, 50.5, 69.5, 84.5, 99.5), 15.0, 55.5
    LIDAR_Z, LIDAR_RANGE = 0.55, 20.0
    BEAMS = np.radians(0.54) * np.arange(667)

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.start = json.loads((XML.parent / "site.json").read_text())["start"]
        waypoints = json.loads((XML.parent / "drive.json").read_text())["waypoints"]
        cls.drive = [cls.start["position"][:2]] + [waypoint["position"] for waypoint in waypoints]
        cls.samples = np.concatenate([np.linspace(a, b, 1 + int(np.hypot(*np.subtract(b, a)) / 0.5), endpoint=False)
                                      for a, b in zip(cls.drive, cls.drive[1:])])

    def scan(self, x, y):
        return np.array([self.range((x, y, self.LIDAR_Z), (np.cos(b), np.sin(b), 0.0), LIDAR_SEES)[0] for b in self.BEAMS])

    def lowest(self, geom):
        """Height of the lowest point of a box, cylinder, capsule or ellipsoid."""
        size, up = self.model.geom_size[geom], np.abs(self.data.geom_xmat[geom].reshape(3, 3)[2])  # the world's z in the geom
        reach = {mujoco.mjtGeom.mjGEOM_BOX: up @ size, mujoco.mjtGeom.mjGEOM_CYLINDER: np.hypot(*up[:2]) * size[0] + up[2] * size[1],
                 mujoco.mjtGeom.mjGEOM_CAPSULE: size[0] + up[2] * size[1], mujoco.mjtGeom.mjGEOM_ELLIPSOID: np.linalg.norm(up * size)}
        return self.data.geom_xpos[geom][2] - reach[mujoco.mjtGeom(self.model.geom_type[geom])]

    def test_its_fence_encloses_118_by_88_metres(self):
        for axis, inside in (((1, 0, 0), 118.0), ((0, 1, 0), 88.0)):
            both = [self.range((60.0, 7.0, 0.3) if axis[0] else (7.0, 45.0, 0.3), np.multiply(sign, axis), IN_THE_WAY) for sign in (-1, 1)]
            self.assertTrue(all(name.startswith("fence") for _, name in both), both)
            self.assertAlmostEqual(sum(distance for distance, _ in both), inside, delta=0.5)

    def test_six_bays_look_the_same_to_a_lidar_on_the_path(self):
        for off in (-2.0, 0.0, 2.0):
            reach = self.BAY_WIDTH / 2 - 1.2 - abs(off)  # what stands in the bay, and nothing of its neighbours
            first = np.minimum(self.scan(self.BAYS[0] + off, self.PATH_Y), reach)
            self.assertGreater((first < reach).sum(), 40)
            for x in self.BAYS[1:]:
                np.testing.assert_allclose(np.minimum(self.scan(x + off, self.PATH_Y), reach), first, atol=1e-6)

    def test_the_lidar_sees_little_and_thin_things_a_twentieth_to_half_of_its_beams_return(self):
        for x, y in self.samples[::100]:
            returned = self.scan(x, y) < self.LIDAR_RANGE
            self.assertTrue(0.05 < returned.mean() < 0.5, f"{returned.mean():.2f} at {x:.1f}, {y:.1f}")
        on_the_path = self.scan(self.BAYS[1], self.PATH_Y) < self.LIDAR_RANGE
        self.assertGreater(np.count_nonzero(np.diff(on_the_path.astype(int)) == 1), 30)  # things, each apart from the next

    def test_what_is_live_hangs_above_4_and_a_half_metres_but_behind_the_reactors_own_fence(self):
        live = [i for i in range(self.model.ngeom) if self.model.geom_matid[i] == self.model.material("aluminium").id
                and not self.model.geom(i).name.startswith("reactor")]
        self.assertGreater(len(live), 500)
        self.assertGreater(min(self.lowest(i) for i in live), 4.5)

    def test_the_drive_is_900_metres_long_and_ends_as_it_began(self):
        self.assertGreater(np.hypot(*np.diff(self.drive, axis=0).T).sum(), 900.0)
        self.assertEqual(self.drive[0], self.drive[-1])
        self.assertEqual(self.start["orientation"], [0.0, 0.0, 0.0, 1.0])
        self.assertEqual(json.loads((XML.parent / "drive.json").read_text())["waypoints"][-1]["mark_heading_deg"], 0.0)

    def test_half_of_the_drive_is_driven_in_both_directions(self):
        steps = [np.subtract(b, a) for a, b in zip(self.samples, self.samples[1:])]
        ways = np.array([step / np.hypot(*step) for step in steps])
        middles = (self.samples[:-1] + self.samples[1:]) / 2
        again = [((np.hypot(*(middles - p).T) < 1.5) & (ways @ way < -0.9)).any() for p, way in zip(middles, ways)]
        self.assertGreater(np.mean(again), 0.5)

    def test_the_drive_is_level_and_keeps_a_metre_from_everything(self):
        bearings = np.linspace(0.0, 2.0 * np.pi, 180, endpoint=False)  # 3.5 cm apart at a metre: no post is thinner
        directions = np.stack([np.cos(bearings), np.sin(bearings), 0.0 * bearings], axis=1)
        geom, distance = np.empty(len(bearings), np.int32), np.empty(len(bearings))
        for x, y in self.samples:
            self.assertLess(abs(self.ground_at(x, y)), 0.01, f"at {x:.2f}, {y:.2f}")
            for z in (0.12, self.LIDAR_Z):
                mujoco.mj_multiRay(self.model, self.data, (x, y, z), directions.ravel(), IN_THE_WAY, 1, -1, geom, distance, None, len(bearings), 1.4)
                near = {self.model.geom(i).name for i in geom[(distance >= 0.0) & (distance < 1.0)]}
                self.assertFalse(near, f"at {x:.2f}, {y:.2f}")

    def test_the_drive_keeps_5_metres_from_mesh_that_a_lidar_would_see_from_nearer(self):
        meshes = [i for i in range(self.model.ngeom) if self.model.geom(i).name.startswith("fence") and self.model.geom(i).name.endswith("mesh")]
        self.assertGreater(len(meshes), 6)
        for i in meshes:
            beyond = np.abs(self.samples - self.data.geom_xpos[i][:2]) - self.model.geom_size[i][:2]
            self.assertGreater(np.hypot(*np.maximum(beyond, 0.0).T).min(), 4.99, self.model.geom(i).name)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], "-v", WORLD])
