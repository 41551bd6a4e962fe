"""The program with `--prefer accurate`: the model that the errors select."""

from peers import sistership

NEEDS = ("numpy",)


def fit(task):
    return sistership.fit(task, "--prefer", "accurate")
