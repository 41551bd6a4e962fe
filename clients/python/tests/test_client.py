"""Against the server that `SISTERSHIP_URL` names; `SISTERSHIP_SHIP` and `SISTERSHIP_TRIALS` are a
vessel's file and a folder of CSV files with canonical columns."""

import math
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

from sistership import (Client, CommandFailed, Model, NoAnswer, Refused, Track, estimate,
                        run_command)

HERE = pathlib.Path(__file__).resolve().parent.parent


class Generated(unittest.TestCase):
    def test_core_is_what_the_interface_says(self):
        done = subprocess.run([sys.executable, str(HERE / "generate.py"), "--check"])
        self.assertEqual(done.returncode, 0)


@unittest.skipUnless("SISTERSHIP_PROGRAM" in os.environ, "no program")
class WithoutAServer(unittest.TestCase):
    def test_a_command_gives_its_document(self):
        ranking = run_command("similar", "kvlcc2")["ranking"]
        self.assertIn("esso-tanker", [one["ship"] for one in ranking])

    def test_a_refusal_has_the_reason(self):
        with self.assertRaises(CommandFailed) as caught:
            run_command("similar", "no-such-ship")
        self.assertEqual(caught.exception.exit_status, 1)
        self.assertIn("no-such-ship", str(caught.exception))
        with self.assertRaises(CommandFailed) as caught:
            Model("kvlcc2").manoeuvre(turn_deg=400.0)
        self.assertEqual(caught.exception.exit_status, 2)

    def test_a_model_of_the_zoo_turns_as_the_program_simulates_it(self):
        model = Model("mariner")
        turn, = model.manoeuvre(turn_deg=35.0)["turns"]
        track = model(600.0, delta_order=math.radians(35.0))
        self.assertAlmostEqual(max(track["y_m"]), turn["max_transfer_m"], delta=1.0)

    def test_an_estimate_is_a_model(self):
        model = estimate(HERE / "tests" / "my-ship.yaml")
        self.assertGreater(model(300.0, delta_order=0.3)["psi_rad"][-1], 0.5)
        with tempfile.TemporaryDirectory() as folder:
            copy = Model(model.write(pathlib.Path(folder) / "copy.yaml"))
        self.assertEqual(copy.module.COEFFICIENTS, model.module.COEFFICIENTS)


@unittest.skipUnless("SISTERSHIP_URL" in os.environ, "no server")
class Journey(unittest.TestCase):
    def setUp(self):
        self.client = Client(os.environ["SISTERSHIP_URL"])

    def test_a_ship_is_refined_and_sailed(self):
        ship = self.client.create(pathlib.Path(os.environ["SISTERSHIP_SHIP"]).read_text())
        files = sorted(pathlib.Path(os.environ["SISTERSHIP_TRIALS"]).glob("*.csv"))
        kept = [ship.upload(file.read_bytes(), name=file.name) for file in files]
        self.assertEqual(sorted(trial.id for trial in ship.trials()),
                         sorted(trial.id for trial in kept))
        self.assertEqual(kept[0].csv().splitlines()[0].split(",")[0], "t_s")
        self.assertEqual(len(kept[0].csv().splitlines()), kept[0].about["rows"] + 1)
        told = []
        job = ship.refine(source="sr108", settings={"method": "published"})
        result = job.wait(progress=lambda share, words: told.append(share), every_s=0.05)
        self.assertEqual((result["version"], told[-1]), (1, 1.0))
        champion = ship.champion()
        self.assertEqual(champion.number, 1)
        found = self.client.compare([champion, "kvlcc2"], trials=kept[:1])
        self.assertEqual([one["law"] for one in found["models"]], ["son-nomoto", "mmg"])
        self.assertEqual(self.client.version("journey").name, "journey/1")
        self.assertLess(champion.coefficients["N_r"]["value"], 0.0)
        self.files_as_the_yard_writes_them(ship)

    def files_as_the_yard_writes_them(self, ship):
        """Own columns by a manifest; one cell is empty, and is named by row and column."""
        rows = [f"{t},{15 - t / 100},0,{t / 4},{t * t / 480},{-t / 10}" for t in range(60)]
        rows[7] = rows[7].replace(",0,", ",,")
        columns = {"t": ("t", "s"), "u": ("ahead", "kn"), "v": ("to stbd", "kn"),
                   "r": ("ROT", "deg/min"), "psi": ("heading", "deg"), "delta": ("port", "deg")}
        manifest = {
            "conventions": {"rudder_positive": "port_turn"},
            "columns": {name: {"column": column, "unit": unit}
                        for name, (column, unit) in columns.items()},
            "trials": [{"file": "a \"turn\".csv"}]}
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "a \"turn\".csv"
            head = ",".join(column for column, _ in columns.values())
            file.write_text("\n".join([head, *rows]))
            with self.assertRaises(Refused) as caught:
                ship.upload_files([file.name], manifest, folder)
            self.assertIn("row 9, to stbd: the cell is empty", str(caught.exception))
            self.assertEqual(caught.exception.errors[0]["row"], 9)
            manifest["conventions"]["missing"] = "drop"
            read, = ship.upload_files([file.name], manifest, folder, diagnose=False)
        self.assertIn("row 9 skipped", read.warnings[0]["message"])
        last = read.csv().splitlines()[-1].split(",")
        delta_rad = float(last[read.csv().splitlines()[0].split(",").index("delta_rad")])
        self.assertAlmostEqual(delta_rad, math.radians(5.9))

    def test_the_champion_here_sails_as_on_the_server(self):
        version = self.client.ship("kvlcc2").champion()
        there = Track.of(version.manoeuvre(turn_deg=35.0)["trajectory"])
        here = version(100.0, delta_order=math.radians(35.0))
        self.assertEqual(repr(here), "Track(1001 samples, 100 s)")
        for column in ("u_m_s", "x_m", "psi_rad", "delta_rad"):
            for a, b in zip(here[column], there[column]):
                self.assertAlmostEqual(a, b, delta=1e-6)
        with self.assertRaisesRegex(TypeError, "no input rudder; the inputs are delta_order, n,"):
            version(100.0, rudder=0.6)

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
        with tempfile.TemporaryDirectory() as folder:
            path = self.client.version("kvlcc2/1").save("fmu3", pathlib.Path(folder) / "tanker.fmu")
            self.assertEqual(pathlib.Path(path).read_bytes()[:2], b"PK")

    def test_nobody_answers(self):
        with self.assertRaisesRegex(NoAnswer, "no server answers at http://127.0.0.1:1"):
            Client("http://127.0.0.1:1").ship("kvlcc2")

    def test_refusals_name_the_field(self):
        with self.assertRaises(Refused) as caught:
            self.client.compare(["kvlcc2", "lost"])
        self.assertEqual(caught.exception.status, 422)
        self.assertIn("version: there is no model `lost`", str(caught.exception))


if __name__ == "__main__":
    unittest.main()
