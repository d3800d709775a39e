"""A cluster of two nodes on one machine, each with its own Ray daemon, core and kernel cache."""

import tempfile
import time
from pathlib import Path
from typing import Any

import numpy as np
import ray
from ray.cluster_utils import Cluster
from rllib_ppo import make_config

CORES = 1  # of each node: room for one runner
STORE = 100_000_000  # bytes of each node's object store
PATIENCE = 300  # seconds until a lost runner must be back


def check_two_nodes() -> str:
    """Train on two nodes, lose one, continue on the other, and get the lost one back."""
    with tempfile.TemporaryDirectory() as folder:
        caches = [Path(folder, name) for name in ("head", "worker")]
        cluster = Cluster(
            initialize_head=True, head_node_args=_node(caches[0]) | {"include_dashboard": False}
        )
        try:
            worker = cluster.add_node(**_node(caches[1]))
            ray.init(address=cluster.address, log_to_driver=False)
            return _train(cluster, worker, caches)
        finally:
            ray.shutdown()
            cluster.shutdown()


def _node(cache: Path) -> dict[str, Any]:
    return {
        "num_cpus": CORES,
        "object_store_memory": STORE,
        "env_vars": {"ARKANOID_CACHE_DIR": str(cache)},
    }


def _train(cluster: Cluster, worker: Any, caches: list[Path]) -> str:
    start = time.perf_counter()
    algorithm = make_config(runners=2, seed=0).build_algo()
    try:
        algorithm.train()
        seconds = time.perf_counter() - start
        assert _homes(algorithm) == {node["NodeID"] for node in ray.nodes()}
        kernels = [len(list(cache.rglob("*.nbc"))) for cache in caches]
        assert min(kernels) > 0, "a node compiled nothing"
        _check_weights(algorithm)
        lines = [
            f"two nodes of {CORES} core each: a runner on each, with the learner's weights;",
            f"{kernels[0]} and {kernels[1]} kernels compiled into the nodes' own caches, "
            f"the first iteration done after {seconds:.0f} s",
        ]
        cluster.remove_node(worker, allow_graceful=False)
        played = _iterate(algorithm, 3)
        lines.append(f"a node killed: {played:,} more decisions with the runner that is left")
        assert len(_homes(algorithm)) == 1
        cluster.add_node(**_node(caches[1]))
        start = time.perf_counter()
        while len(_homes(algorithm)) < 2 and time.perf_counter() - start < PATIENCE:
            _iterate(algorithm, 1)
        assert len(_homes(algorithm)) == 2, "the lost runner did not come back"
        _iterate(algorithm, 1)
        _check_weights(algorithm)
        seconds = time.perf_counter() - start
        lines.append(f"a node joined: two runners again, {seconds:.0f} s later")
        return "\n".join(lines)
    finally:
        algorithm.stop()


def _iterate(algorithm: Any, iterations: int) -> int:
    """Train, and return how many decisions were played."""
    played = 0
    for _ in range(iterations):
        # The sum over the lifetime loses the decisions of a runner that is gone.
        played += round(algorithm.train()["env_runners"]["num_env_steps_sampled"])
    return played


def _homes(algorithm: Any) -> set[str]:
    """Return the nodes that have runners."""
    return set(
        algorithm.env_runner_group.foreach_env_runner(
            lambda runner: ray.get_runtime_context().get_node_id(), local_env_runner=False
        )
    )


def _check_weights(algorithm: Any) -> None:
    """Check that all runners play with the weights of the learner."""
    learned = algorithm.learner_group.get_weights()["default_policy"]
    for played in algorithm.env_runner_group.foreach_env_runner(
        lambda runner: runner.module.get_state(), local_env_runner=False
    ):
        assert played
        for name, weights in played.items():
            np.testing.assert_array_equal(weights, learned[name])
