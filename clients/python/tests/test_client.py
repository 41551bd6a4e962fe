"""Against the server that `SISTERSHIP_URL` names; `SISTERSHIP_SHIP` and `SISTERSHIP_TRIALS` are a
vessel's file and a folder of CSV files with canonical columns."""

import math
import os
import pathlib
import subprocess
import sys
import unittest

from sistership_client import Client, Refused, Track

HERE = pathlib.Path(__file__).resolve().parent.parent


class Generated(unittest.TestCase):
    def test_core_is_what_the_interface_says(self):
        done = subprocess.run([sys.executable, str(HERE / "generate.py"), "--check"])
        self.assertEqual(done.returncode, 0)


@unittest.skipUnless("SISTERSHIP_URL" in os.environ, "no server")
class Journey(unittest.TestCase):
    def setUp(self):
        self.client = Client(os.environ["SISTERSHIP_URL"])

    def test_a_ship_is_refined_and_sailed(self):
        ship = self.client.create(pathlib.Path(os.environ["SISTERSHIP_SHIP"]).read_text())
        files = sorted(pathlib.Path(os.environ["SISTERSHIP_TRIALS"]).glob("*.csv"))
        ids = [ship.upload(file.read_bytes(), name=file.name) for file in files]
        self.assertEqual(sorted(trial["id"] for trial in ship.trials()), sorted(ids))
        told = []
        job = ship.refine(source="sr108", settings={"method": "published"})
        result = job.wait(progress=lambda share, words: told.append(share), every_s=0.05)
        self.assertEqual((result["version"], told[-1]), (1, 1.0))
        champion = ship.champion()
        self.assertEqual(champion.number, 1)
        found = self.client.compare([champion, "kvlcc2"], trials=ids[:1])
        self.assertEqual([one["law"] for one in found["models"]], ["son-nomoto", "mmg"])

    def test_the_champion_here_sails_as_on_the_server(self):
        version = self.client.ship("kvlcc2").champion()
        there = Track.of(version.manoeuvre(turn_deg=35.0)["trajectory"])
        here = version(100.0, delta_order=math.radians(35.0))
        self.assertEqual(len(here["t_s"]), 1001)
        for column in ("u_m_s", "x_m", "psi_rad", "delta_rad"):
            for a, b in zip(here[column], there[column]):
                self.assertAlmostEqual(a, b, delta=1e-6)

    def test_a_ship_under_way_takes_orders(self):
        with self.client.ship("mariner").champion().under_way(start={"u_m_s": 7.0}) as ship:
            ship.step(0.5, steps=10, delta_rad=0.3)
            track = Track.of(ship.step(0.5, steps=10)["trajectory"])
            self.assertAlmostEqual(track["t_s"][-1], 10.0)
            self.assertEqual(ship.now["psi_rad"], track["psi_rad"][-1])
            self.assertGreater(track["psi_rad"][-1], 0.01)
        with self.assertRaises(Refused) as caught:
            ship.step(0.5)
        self.assertEqual(caught.exception.status, 404)

    def test_exports_and_searches(self):
        names = [ship.name for ship in self.client.ships(category="tanker", limit=2)]
        self.assertTrue({"kvlcc2", "esso-tanker"} <= set(names) and len(set(names)) == len(names))
        self.assertEqual(self.client.ship("kvlcc2").version(1).export("fmu3")[:2], b"PK")

    def test_refusals_name_the_field(self):
        with self.assertRaises(Refused) as caught:
            self.client.compare(["kvlcc2", "lost"])
        self.assertEqual(caught.exception.status, 422)
        self.assertIn("version: there is no model `lost`", str(caught.exception))


if __name__ == "__main__":
    unittest.main()
