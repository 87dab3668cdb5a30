from __future__ import annotations

import pyarrow as pa
import pyarrow.compute as pc
import pyarrow.parquet as pq
import pytest

from sideband_datasets.folder import Settings, make
from sim.presets import preset
from tests.sideband_datasets.folder.attack import changed, rewrite, shards, told
from tests.sideband_datasets.small import document, tiny


def test_a_machine_moved_to_another_split_is_found(copy):
    moved = pq.read_table(shards(copy, "train")[0]).column("machine_id")[0].as_py()
    taken = []
    for path in shards(copy, "train"):
        table = pq.read_table(path)
        of_it = pc.equal(table.column("machine_id"), moved)
        taken.append(table.filter(of_it))
        rewrite(copy, path, table.filter(pc.invert(of_it)))
    path = shards(copy, "test")[0]
    joined = pa.concat_tables(taken)
    more = pa.concat_tables([pq.read_table(path), changed(joined, "split", ["test"] * joined.num_rows)])
    rewrite(copy, path, more)
    found = told(copy)
    assert f"{path.name}: split is not the planned one in {joined.num_rows} rows" in found
    assert "'test', planned 'train'" in found
    assert "leak: machine_id" not in found  # it is whole in its new split


def test_two_splits_that_changed_places_are_found(copy):
    pairs = list(zip(shards(copy, "train"), shards(copy, "test"), strict=True))
    tables = [(pq.read_table(one), pq.read_table(other)) for one, other in pairs]
    for (one, other), (first, second) in zip(pairs, tables, strict=True):
        rewrite(copy, one, changed(second, "split", ["train"] * second.num_rows))
        rewrite(copy, other, changed(first, "split", ["test"] * first.num_rows))
    found = told(copy)
    for path in (*shards(copy, "train"), *shards(copy, "test")):
        assert f"{path.name}: split is not the planned one in 8 rows" in found


@pytest.mark.parametrize(
    ("column", "value"),
    [
        ("fault_type", "healthy"),
        ("labels", ["outer_spall@bearing9"]),
        ("severities", [1.0]),
        ("fault_location", "bearing9"),
        ("fault_severity", 1.0),
        ("path_id", "zzz"),
        ("machine_id", "zzz"),
        ("recording_id", "tiny-000000"),
        ("channel", "dee"),
        ("window", 7),
        ("seed", 1),
        ("signal_id", "tiny"),
    ],
)
def test_a_column_that_is_not_the_planned_one_is_found(copy, column, value):
    path = shards(copy, "test")[1]
    table = pq.read_table(path)
    rewrite(copy, path, changed(table, column, [value] * table.num_rows))
    assert f"{path.name}: {column} is not the planned one in " in told(copy)


def test_signals_of_train_in_test_are_found(copy):
    one, other = shards(copy, "train")[0], shards(copy, "test")[0]
    signals = pq.read_table(one).column("signal").to_pylist()
    rewrite(copy, other, changed(pq.read_table(other), "signal", signals))
    found = told(copy)
    assert f"data: leak: {len(signals)} signals stand in two splits, bit for bit: row " in found


@pytest.mark.slow
def test_pulses_of_a_tacho_may_be_the_same_in_two_splits(tmp_path):
    (chosen,) = document()["measurement"]
    chosen["chain"]["channels"].append({"name": "turns", "kind": "tacho", "shaft": preset("rotor").shafts[0].name})
    windows = {"per_recording": 1, "length_s": 0.1}
    recipe = tiny(count=4, faults=[], speeds_hz=30.0, measurement=[chosen], windows=windows, peaks={"spectra": []})
    make(recipe, tmp_path / "set", Settings(), lambda progress: None)
    found = {}
    for split in ("train", "test"):
        (path,) = shards(tmp_path / "set", split)
        table = pq.read_table(path)
        found[split] = table.filter(pc.equal(table.column("channel"), "turns")).column("signal").to_pylist()
    assert found["train"][0] in found["test"]
    assert told(tmp_path / "set") == ""
