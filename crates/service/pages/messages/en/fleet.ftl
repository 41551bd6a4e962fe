## Headings and collections

fleet-title = Fleet
fleet-collections = Collections
fleet-own = Your fleet
fleet-library = Library
fleet-library-heading = Library of published ships
fleet-all = All ships
fleet-add = Add a ship
fleet-library-explained = Published ships that the program brings: sources of refinements, and examples. A ship with trials of its own is part of your fleet.
fleet-changing = Some ships changed a moment ago; this order is updated within seconds.

## First steps

steps-label = First steps
step-state-done = done
step-state-next = next
step-state-later = later
step-add-title = Add your ship
step-add-text = Length, beam, draught and displacement are enough to begin with.
step-upload-title = Upload its trials
step-upload-text = Turning circles and zigzags, as recorded; the columns are identified.
step-refine-title = Refine its model
step-refine-text = The model of the most similar ship is fitted to the trials, and judged on manoeuvres that it has not seen.
steps-looking = Only looking around?
steps-example = Load the example
steps-example-explained = adds a container ship of 175 m with eight simulated trials, ready to be refined

## Overview

board-counts = Ships by condition
board-worst = Need attention first
board-recent = Changed this week
board-drift = Drift of the fleet
board-drift-explained = Unexplained force on new trials divided by that on the fitted ones: median of the diagnoses of each week, with their number. Above the line a model is in doubt.
board-drift-label = Median drift of the diagnoses of each week, { $last } in the last; a model is in doubt above { $limit }
board-today = today
board-unexplained = something unexplained
change-diagnosed-complete = a diagnosis found nothing missing
change-diagnosed-effects = a diagnosis found a missing effect
change-diagnosed-other = a diagnosis found an unexplained remainder
change-promoted = version { $number } came into use
change-made = version { $number } was made
change-uploaded = { $count ->
        [one] 1 trial was uploaded
       *[other] { $count } trials were uploaded
    }
change-added = the ship was added

## Condition

condition-class-does-not-hold = does not hold
condition-class-unknown = not diagnosed
condition-class-no-model = no model
condition-class-holds = holds
condition-drift = drift
condition-drift-times = drift, { $ratio } times

## Search

search-heading = Search and order
search-all-ships = all
search-own = your fleet
search-library = library
search-condition = Condition
search-order = Order
search-order-worst = worst first
search-order-name = name
search-order-value = value of the particular or figure
search-from = Names starting from (order by name)
search-further = Search by category, tag, particulars, manoeuvres and similarity
search-tag = Tag
search-similar = Most similar to the ship
search-particular = A particular, SI
search-least = At least
search-most = At most
search-figure-legend = A figure of the champion's standard manoeuvres, the greater of both sides
search-figure = Figure
search-correlation = Correlation
search-wrong-order = choose one of worst, name and value, not `{ $text }`
search-order-by-name = order by name is possible only without condition, particular and metric; order by value or worst first
search-order-by-value = order by value needs a range of a particular or metric
search-no-class = there is no `{ $name }`

## List

fleet-none-own = No ship of your own yet. The <a href="/?ships=library">library of published ships</a> can be looked at, compared and simulated.
fleet-compare-marked = Compare the marked ships
fleet-compare-hint = two to five, each by the version in use
fleet-mark-ship = Mark { $ship }
fleet-in-use = In use
fleet-unexplained = Unexplained force
fleet-no-match = No ship matches.
fleet-further = Further ships
fleet-spark = Unexplained force of { $count } trials over time, { $last } % in the last

## Meaning of the columns

columns-heading = What the columns mean
columns-in-use = the version that is the champion of the ship
columns-holds-name = Holds
columns-holds = the residual of the champion on the newest trials agrees with the noise
columns-does-not-hold-name = Does not hold
columns-does-not-hold = an effect is missing; it is named if the library has one that explains the residual
columns-unknown-name = Not diagnosed
columns-unknown = no diagnosis has been made of the champion
columns-error = mean squared error of simulated held-out manoeuvres, divided by the variance of the measurement: 0 is perfect, 1 no better than the mean
columns-force = unexplained force in each of the newest 24 trials, the oldest first; each line has its own scale

## Map

map-heading = Where the ships are
map-explained = Last known positions: those of the newest trials that have latitude and longitude. <span class="state does-not-hold">cross: does not hold</span> · triangle: not diagnosed · square: no model · <span class="good">circle: holds</span>.
map-most-urgent = The { $shown } most urgent of { $placed } ships are shown.
map-source = Coast lines: Natural Earth.
map-table = Positions as a table
map-positions = Positions
map-position = Position
map-label = Map of the ships; the table below has the same content
map-mark = { $ship }: { $condition }
map-direction-N = N
map-direction-S = S
map-direction-E = E
map-direction-W = W
