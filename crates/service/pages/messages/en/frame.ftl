## Navigation and footer

frame-skip = Skip to the content
frame-menu = Menu
frame-main = Main
place-fleet = Fleet
place-compare = Compare
place-playground = Playground
place-families = Families
place-zoo = Zoo
place-jobs = Jobs
place-users = Users
place-audit = Audit
frame-units = Times are UTC. Values are in SI units; positive rudder turns the ship to starboard.
frame-language = Language

## Words that several pages share

word-yes = yes
word-no = no
word-none = None.
word-none-yet = None yet.
word-none-option = none
word-all = all
word-default = default
word-show = Show
word-mark = Mark
word-ship = Ship
word-ships = Ships
word-version = Version
word-versions = Versions
word-number-version = version { $number }
word-law = Law
word-method = Method
word-report = Report
word-name = Name
word-title = Title
word-category = Category
word-family = Family
word-value = Value
word-unit = Unit
word-source = Source
word-reason = Reason
word-created = Created
word-trials = Trials
word-trial = Trial
word-manoeuvre = Manoeuvre
word-samples = Samples
word-duration = Duration
word-remarks = Remarks
word-remark = Remark
word-uploaded = Uploaded
word-held-out-error = Held-out error
word-lacks = Lacks
word-not-reached = not reached
word-count-trials = { $count ->
        [one] 1 trial
       *[other] { $count } trials
    }
list-and = { $first } and { $last }

## Forms

form-empty = is empty; enter a value
form-required = is required
form-not-a-number = `{ $text }` is not a number; write one such as 12.5
form-outside = must be from { $low } to { $high }, not { $number }
form-not-whole = `{ $text }` is not a whole number
form-cursor = is not a page of this list; start again from the first page
form-no-model = there is no model `{ $name }`; write a ship (its champion), ship/number or ship/alias

## Roles in the choice of a role

role-add = Add the role
role-role = Role
role-on = On
role-on-server = the whole server
role-on-ship = the ship
role-on-family = the family
role-scope-name = Name of the ship or family
role-reader = reader
role-engineer = engineer
role-approver = approver
role-admin = admin
role-of-ship = { $role } of the ship { $name }
role-of-family = { $role } of the family { $name }

## Errors

problem-back = Go back to correct the input, or continue with the <a href="/">fleet</a>.
problem-bad-request = The request cannot be read
problem-unauthorized = A key or a sign-in is needed
problem-forbidden = The request is not allowed
problem-not-found = Not found
problem-method-not-allowed = The method is not supported here
problem-not-acceptable = None of the accepted formats is available
problem-request-timeout = The request took too long to arrive
problem-conflict = The request conflicts with stored data
problem-stale = The resource has changed since it was read
problem-too-large = The request is too large
problem-unsupported-media-type = The content type is not supported here
problem-invalid = The content is not valid
problem-precondition-required = A precondition header is needed
problem-too-many-requests = Too many requests
problem-headers-too-large = The headers are too large
problem-internal = Internal error
problem-unavailable = The server is temporarily unavailable
problem-timeout = The request took too long
problem-no-room = There is no free space
language-unknown = there is no language `{ $code }`; choose one of en, de and nb
