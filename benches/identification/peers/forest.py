"""scikit-learn's random forest on accelerations."""

import numpy as np
from sklearn.ensemble import RandomForestRegressor

from motion import AccelerationModel, accelerations, limits
from selection import select

# Half width of the derivative filter and least number of rows in a leaf.
OPTIONS = [(3, 3), (3, 15), (6, 3), (6, 15)]


def fit(task):
    def fit_option(trials, option):
        width, leaf = option
        rows, rates = accelerations(trials, task.controls, width)
        spread = np.maximum(rates.std(axis=0), 1e-12)
        forest = RandomForestRegressor(40, min_samples_leaf=leaf, random_state=1)
        forest.fit(rows, rates / spread)
        nodes = sum(tree.tree_.node_count for tree in forest.estimators_)
        return AccelerationModel(lambda rows: forest.predict(rows) * spread, task.controls, nodes,
                                 limits(trials))
    return select(OPTIONS, fit_option, task.trials)
