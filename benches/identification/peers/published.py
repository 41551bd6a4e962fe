"""The published model of the ship in the program's zoo, as it is: nothing is fitted."""

from job import CannotDo
from peers.sistership import Model
from program import Program



def fit(task):
    if not task.ship.published:
        raise CannotDo("no published model of this ship in the zoo")
    model = Model(Program(task), task.ship.published)
    model.parameters = 0
    return model
