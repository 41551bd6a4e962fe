"""The program with `--prefer accurate`: the model that the errors select."""

from peers import sistership

DIAGNOSES = True


def fit(task):
    return sistership.fit(task, "--prefer", "accurate")
