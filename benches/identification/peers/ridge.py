"""scikit-learn's ridge on Abkowitz regressors, standardised."""

from sklearn.linear_model import Ridge
from sklearn.pipeline import make_pipeline
from sklearn.preprocessing import StandardScaler

from motion import Abkowitz, AccelerationModel, accelerations, limits
from selection import select

OPTIONS = [(width, alpha) for width in (2, 4, 8) for alpha in (1e-2, 1e-1, 1.0, 10.0, 100.0)]


def fit(task):
    def fit_option(trials, option):
        width, alpha = option
        rows, rates = accelerations(trials, task.controls, width)
        terms = Abkowitz(rows, task.controls)
        scale = rates.std(axis=0)
        model = make_pipeline(StandardScaler(), Ridge(alpha)).fit(terms(rows), rates / scale)
        scaler, ridge = model
        weights = (ridge.coef_ / scaler.scale_).T * scale
        offset = ridge.intercept_ * scale - scaler.mean_ @ weights
        return AccelerationModel(lambda rows: terms(rows) @ weights + offset, task.controls,
                                 weights.size + 3, limits(trials))
    return select(OPTIONS, fit_option, task.trials)
