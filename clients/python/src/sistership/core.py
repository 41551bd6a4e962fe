"""Types and operations of the REST interface, written by `generate.py`: not to be edited."""

from __future__ import annotations

from typing import Any, Dict, List, Literal, Optional, TypedDict, Union

from .http import Http

ActsOn = Any  # The part of the model on which an effect acts.
Actuator = TypedDict('Actuator', {'channels': 'Dict[str, List[str]]', 'diameter_m': 'Union[float, None]', 'kind': 'ActuatorKind', 'note': 'Union[str, None]', 'source': 'str', 'turns': 'Union[Rotation, None]', 'x_m': 'Union[float, None]', 'y_m': 'float'}, total=False)
ActuatorKind = Any  # Kind of an actuator.
AliasRequest = TypedDict('AliasRequest', {'reason': 'str', 'version': 'int'}, total=True)
AliasStep = TypedDict('AliasStep', {'actor': 'str', 'from': 'Union[int, None]', 'moved_us': 'int', 'reason': 'str', 'revision': 'int', 'to': 'int'}, total=False)
AliasView = TypedDict('AliasView', {'alias': 'str', 'model': 'str', 'revision': 'int', 'version': 'int'}, total=True)
AppliedEffect = TypedDict('AppliedEffect', {'acts_on': 'ActsOn', 'form': 'FormFile', 'name': 'str', 'parameters': 'Dict[str, Quantity]'}, total=True)
Axis = Any  # An axis of the equations of motion.
BandsRequest = TypedDict('BandsRequest', {'samples': 'Union[int, None]', 'seed': 'Union[int, None]'}, total=False)
Binary = Any  # A file, byte for byte.
Bound = TypedDict('Bound', {'max': 'Union[float, None]', 'min': 'Union[float, None]'}, total=False)
BranchKind = Any  # Kind of learner, with default settings that suit small data sets.
BranchRequest = TypedDict('BranchRequest', {'model': 'str', 'settings': 'BranchSettings', 'trials': 'Union[List[str], None]'}, total=False)
BranchSettings = TypedDict('BranchSettings', {'fade': 'Union[float, None]', 'hop_s': 'Union[float, None]', 'kind': 'Union[BranchKind, None]', 'learner': 'Union[Learner, None]', 'mode': 'Union[CorrectionMode, None]', 'seed': 'Union[int, None]', 'window_s': 'Union[float, None]'}, total=False)
BulkRefinementRequest = TypedDict('BulkRefinementRequest', {'chunk_ships': 'Union[int, None]', 'prior': 'PriorChoice', 'rule': 'Rule', 'settings': 'BulkSettings', 'start': 'Start'}, total=False)
BulkSettings = TypedDict('BulkSettings', {'difference_s': 'Union[float, None]', 'lambda_count': 'int', 'lambda_max': 'float', 'lambda_min': 'float'}, total=False)
BulkStanding = TypedDict('BulkStanding', {'chunks': 'Dict[str, int]', 'done': 'int', 'left_s': 'Union[float, None]', 'outcomes': 'Dict[str, int]', 'progress': 'float', 'ships': 'int', 'ships_per_s': 'Union[float, None]', 'state': 'str'}, total=False)
BulkView = Any  # A refinement of all members of a family.
CancelledJobs = TypedDict('CancelledJobs', {'cancelled': 'List[str]'}, total=True)
Champion = TypedDict('Champion', {'model': 'Dict[str, Any]', 'ship': 'str', 'version': 'VersionHead'}, total=True)
Channel = Any  # A quantity that a trial may record besides time. Ship-fixed velocities
CmaEs = TypedDict('CmaEs', {'absolute': 'float', 'box_width': 'float', 'cpu_s': 'Union[float, None]', 'deviation': 'float', 'evaluations': 'int', 'fold_share': 'float', 'integration': 'IntegrationMethod', 'largest_population': 'int', 'population': 'int', 'seed': 'int', 'spread': 'float', 'wall_s': 'Union[float, None]'}, total=False)
Column = TypedDict('Column', {'failures': 'List[str]', 'law': 'str', 'lpp_m': 'float', 'model': 'str', 'name': 'str', 'ship': 'str', 'speed_m_s': 'float', 'standardised_mse': 'Union[float, None]'}, total=False)
ComparedCoefficient = TypedDict('ComparedCoefficient', {'name': 'str', 'values': 'List[Union[Estimate, None]]'}, total=True)
ComparedFigure = TypedDict('ComparedFigure', {'name': 'str', 'unit': 'str', 'values': 'List[Union[FigureValue, None]]'}, total=True)
ComparedTrial = TypedDict('ComparedTrial', {'duration_s': 'float', 'errors': 'List[TrialError]', 'samples': 'int', 'trial': 'str'}, total=True)
Comparison = TypedDict('Comparison', {'coefficients': 'List[ComparedCoefficient]', 'figures': 'List[ComparedFigure]', 'models': 'List[Column]', 'trials': 'List[ComparedTrial]'}, total=True)
Condition = TypedDict('Condition', {'against': 'List[str]', 'diagnoses': 'List[WeighedDiagnosis]', 'drift': 'Union[RecentDrift, None]', 'effects': 'List[str]', 'found_by': 'Union[DiagnosisReference, None]', 'model': 'ModelValidity', 'sentence': 'str', 'since': 'Union[SinceTrial, None]', 'trials': 'List[str]', 'verdict': 'Union[str, None]', 'version': 'Union[int, None]', 'with_effects': 'Union[VersionWithEffects, None]'}, total=False)
ConditionsRequest = TypedDict('ConditionsRequest', {'date': 'Union[str, None]', 'depth': 'Union[str, None]', 'displacement': 'Union[str, None]', 'draught_aft_m': 'Union[float, None]', 'draught_fore_m': 'Union[float, None]', 'instruments': 'Union[str, None]', 'place': 'Union[str, None]', 'remarks': 'Union[str, None]', 'sea': 'Union[str, None]', 'wind': 'Union[str, None]'}, total=False)
ConditionsView = TypedDict('ConditionsView', {'conditions': 'Dict[str, Any]'}, total=True)
Constraints = TypedDict('Constraints', {'bounds': 'Dict[str, Bound]', 'dissipative': 'bool', 'physical_signs': 'bool', 'straight_line': 'Union[StraightLine, None]', 'trust_sd': 'Union[float, None]'}, total=False)
CorrectionDocument = TypedDict('CorrectionDocument', {'domain': 'Region', 'fade': 'float', 'mode': 'CorrectionMode', 'outputs': 'List[CorrectionOutput]', 'recipe': 'CorrectionRecipe', 'weights_sha256': 'str'}, total=True)
CorrectionInput = TypedDict('CorrectionInput', {'centre': 'float', 'scale': 'float', 'signal': 'Signal'}, total=True)
CorrectionMode = Any  # Combination of a learned correction with its foundation.
CorrectionOutput = TypedDict('CorrectionOutput', {'axis': 'Axis', 'inputs': 'List[CorrectionInput]', 'range': 'List[float]', 'scale': 'float'}, total=True)
CorrectionRecipe = TypedDict('CorrectionRecipe', {'hop_s': 'float', 'learner': 'Learner', 'seed': 'int', 'trials': 'List[str]', 'window_s': 'float'}, total=True)
CurrentRequest = TypedDict('CurrentRequest', {'speed_m_s': 'float', 'towards_rad': 'float'}, total=True)
DeliveryView = TypedDict('DeliveryView', {'answer': 'Union[str, None]', 'attempts': 'int', 'body': 'Dict[str, Any]', 'created_us': 'int', 'delivered_us': 'Union[int, None]', 'due_us': 'Union[int, None]', 'event': 'str', 'id': 'str'}, total=False)
DiagnosisReference = TypedDict('DiagnosisReference', {'at_us': 'int', 'diagnosis': 'str', 'report': 'str'}, total=True)
DiagnosisRequest = TypedDict('DiagnosisRequest', {'model': 'str', 'settings': 'DiagnosisSettings', 'trials': 'Union[List[str], None]'}, total=False)
DiagnosisSettings = TypedDict('DiagnosisSettings', {'least_evidence': 'float', 'least_step_s': 'Union[float, None]', 'most_effects': 'int', 'prior_odds': 'Dict[str, float]', 'restart_s': 'Union[float, None]', 'slack': 'float'}, total=False)
Discrepancy = TypedDict('Discrepancy', {'deviation': 'float', 'time_s': 'float', 'white': 'float'}, total=True)
Drift = TypedDict('Drift', {'ratio': 'Dict[str, float]', 'reason': 'Union[str, None]', 'ship': 'str', 'trials': 'List[TrialResidual]', 'version': 'int', 'worst': 'Union[float, None]'}, total=False)
EffectLibraryHead = TypedDict('EffectLibraryHead', {'created_us': 'int', 'sha256': 'str'}, total=True)
EffectParameterFile = TypedDict('EffectParameterFile', {'absent': 'float', 'bounds': 'List[float]', 'meaning': 'str', 'mirror': 'Mirror', 'prior': 'PriorFile', 'shape': 'bool', 'start': 'Union[float, None]', 'unit': 'str'}, total=False)
EntryView = TypedDict('EntryView', {'action': 'str', 'actor': 'str', 'after': 'Union[Dict[str, Any], None]', 'at_us': 'int', 'before': 'Union[Dict[str, Any], None]', 'number': 'int', 'origin': 'str', 'previous_sha256': 'str', 'row_sha256': 'Union[str, None]', 'sha256': 'str', 'subject': 'str'}, total=False)
Estimate = TypedDict('Estimate', {'standard_error': 'Union[float, None]', 'value': 'float'}, total=False)
Estimator = Any  # The estimator.
FalseAlarmLevel = TypedDict('FalseAlarmLevel', {'each': 'float', 'together': 'float'}, total=True)
FamilyDrift = TypedDict('FamilyDrift', {'family': 'str', 'members': 'int', 'ships': 'List[MemberDrift]'}, total=True)
FamilyView = TypedDict('FamilyView', {'created_us': 'int', 'foundation': 'str', 'members': 'int', 'name': 'str', 'prior': 'Union[int, None]', 'title': 'str'}, total=False)
Fault = TypedDict('Fault', {'column': 'Union[str, None]', 'field': 'Union[str, None]', 'message': 'str', 'row': 'Union[int, None]'}, total=False)
FigureValue = TypedDict('FigureValue', {'pass': 'Union[bool, None]', 'value': 'Union[float, None]'}, total=False)
Form = TypedDict('Form', {'file': 'List[str]', 'manifest': 'Union[str, None]', 'ship': 'Union[str, None]'}, total=False)
FormFile = TypedDict('FormFile', {'accelerates': 'Dict[str, str]', 'bands': 'Dict[str, str]', 'coefficients': 'Dict[str, str]', 'forces': 'Dict[str, str]', 'lags': 'Dict[str, str]', 'meaning': 'str', 'measures': 'Dict[str, str]', 'misfit': 'Union[float, None]', 'name': 'str', 'needs': 'List[Channel]', 'only_as_change': 'bool', 'only_without_roll': 'bool', 'parameters': 'Dict[str, EffectParameterFile]', 'particulars': 'Dict[str, str]', 'reports': 'Dict[str, str]', 'sees': 'Dict[str, str]', 'unless': 'List[Channel]', 'values': 'Dict[str, str]'}, total=False)
FreeRunning = TypedDict('FreeRunning', {'kind': 'FreeRunningKind', 'note': 'Union[str, None]', 'source': 'str', 'speed_m_s': 'Union[float, None]', 'turns': 'List[PublishedTurn]', 'zigzags': 'List[PublishedZigzag]'}, total=False)
FreeRunningKind = Any  # Kind of a free-running trial.
HeadView = TypedDict('HeadView', {'number': 'int', 'sha256': 'str'}, total=True)
Health = TypedDict('Health', {'revision': 'str', 'status': 'str', 'writes': 'Union[str, None]'}, total=False)
HorizonRequest = TypedDict('HorizonRequest', {'current': 'Union[CurrentRequest, None]', 'delta_rad': 'float', 'draws': 'Union[int, None]', 'dt_s': 'Union[float, None]', 'duration_s': 'float', 'orders': 'List[TimedOrders]', 'seed': 'Union[int, None]', 'start': 'Union[InitialState, None]', 'wind': 'Union[WindRequest, None]'}, total=False)
IdentitiesRequest = TypedDict('IdentitiesRequest', {'identities': 'List[IdentityRequest]'}, total=True)
IdentityRequest = TypedDict('IdentityRequest', {'issuer': 'str', 'subject': 'str'}, total=True)
IdentityView = TypedDict('IdentityView', {'issuer': 'str', 'subject': 'str'}, total=True)
InitialState = TypedDict('InitialState', {'p_rad_s': 'float', 'phi_rad': 'float', 'psi_rad': 'float', 'r_rad_s': 'float', 'u_m_s': 'float', 'v_m_s': 'float', 'x_m': 'float', 'y_m': 'float'}, total=False)
InputsRequest = TypedDict('InputsRequest', {'delta_rad': 'List[float]', 'n_rps': 'Union[List[float], None]', 'start': 'InitialState', 't_s': 'List[float]'}, total=False)
InstrumentFit = TypedDict('InstrumentFit', {'deviation_by_scatter': 'float', 'drift': 'float'}, total=True)
IntegrationMethod = Any  # An integration method.
JobView = TypedDict('JobView', {'attempt': 'int', 'author': 'str', 'cancel_requested': 'bool', 'created_us': 'int', 'error': 'Union[str, None]', 'finished_us': 'Union[int, None]', 'id': 'str', 'kind': 'str', 'message': 'str', 'place': 'Union[int, None]', 'progress': 'float', 'request': 'Dict[str, Any]', 'result': 'Union[Dict[str, Any], None]', 'ship': 'Union[str, None]', 'started_us': 'Union[int, None]', 'state': 'str'}, total=False)
KeyRequest = TypedDict('KeyRequest', {'expires_us': 'Union[int, None]', 'roles': 'List[RoleRequest]', 'title': 'str', 'user': 'Union[str, None]'}, total=False)
KeyView = TypedDict('KeyView', {'created_us': 'int', 'expires_us': 'Union[int, None]', 'last_used_us': 'Union[int, None]', 'prefix': 'str', 'revoked_us': 'Union[int, None]', 'roles': 'List[RoleView]', 'title': 'str', 'user': 'Union[str, None]'}, total=False)
LawHead = TypedDict('LawHead', {'created_us': 'int', 'name': 'str', 'sha256': 'str'}, total=True)
LawText = TypedDict('LawText', {'created_us': 'int', 'document': 'str', 'name': 'str', 'sha256': 'str'}, total=True)
Learner = Any  # Learning algorithm.
Listing_AliasStep = TypedDict('Listing_AliasStep', {'items': 'List[Dict[str, Any]]', 'next': 'Union[str, None]'}, total=False)
Listing_AliasView = TypedDict('Listing_AliasView', {'items': 'List[Dict[str, Any]]', 'next': 'Union[str, None]'}, total=False)
Listing_BulkView = TypedDict('Listing_BulkView', {'items': 'List[Any]', 'next': 'Union[str, None]'}, total=False)
Listing_DeliveryView = TypedDict('Listing_DeliveryView', {'items': 'List[Dict[str, Any]]', 'next': 'Union[str, None]'}, total=False)
Listing_EffectLibraryHead = TypedDict('Listing_EffectLibraryHead', {'items': 'List[Dict[str, Any]]', 'next': 'Union[str, None]'}, total=False)
Listing_EntryView = TypedDict('Listing_EntryView', {'items': 'List[Dict[str, Any]]', 'next': 'Union[str, None]'}, total=False)
Listing_FamilyView = TypedDict('Listing_FamilyView', {'items': 'List[Dict[str, Any]]', 'next': 'Union[str, None]'}, total=False)
Listing_JobView = TypedDict('Listing_JobView', {'items': 'List[Dict[str, Any]]', 'next': 'Union[str, None]'}, total=False)
Listing_KeyView = TypedDict('Listing_KeyView', {'items': 'List[Dict[str, Any]]', 'next': 'Union[str, None]'}, total=False)
Listing_LawHead = TypedDict('Listing_LawHead', {'items': 'List[Dict[str, Any]]', 'next': 'Union[str, None]'}, total=False)
Listing_MemberView = TypedDict('Listing_MemberView', {'items': 'List[Dict[str, Any]]', 'next': 'Union[str, None]'}, total=False)
Listing_NoteView = TypedDict('Listing_NoteView', {'items': 'List[Dict[str, Any]]', 'next': 'Union[str, None]'}, total=False)
Listing_OutcomeView = TypedDict('Listing_OutcomeView', {'items': 'List[Dict[str, Any]]', 'next': 'Union[str, None]'}, total=False)
Listing_ShipHead = TypedDict('Listing_ShipHead', {'items': 'List[Dict[str, Any]]', 'next': 'Union[str, None]'}, total=False)
Listing_TrialView = TypedDict('Listing_TrialView', {'items': 'List[Dict[str, Any]]', 'next': 'Union[str, None]'}, total=False)
Listing_UserView = TypedDict('Listing_UserView', {'items': 'List[Dict[str, Any]]', 'next': 'Union[str, None]'}, total=False)
Listing_VersionHead = TypedDict('Listing_VersionHead', {'items': 'List[Dict[str, Any]]', 'next': 'Union[str, None]'}, total=False)
Listing_WebhookView = TypedDict('Listing_WebhookView', {'items': 'List[Dict[str, Any]]', 'next': 'Union[str, None]'}, total=False)
ManoeuvreRequest = TypedDict('ManoeuvreRequest', {'all': 'bool', 'bands': 'Union[BandsRequest, None]', 'n_rps': 'Union[float, None]', 'speed_m_s': 'Union[float, None]', 'turn_deg': 'Union[float, None]', 'zigzag': 'Union[ZigzagRequest, None]'}, total=False)
Me = TypedDict('Me', {'kind': 'str', 'name': 'str', 'roles': 'List[RoleView]'}, total=True)
MemberDrift = TypedDict('MemberDrift', {'condition': 'Condition', 'drift': 'Union[Drift, None]', 'ship': 'str'}, total=False)
MemberView = TypedDict('MemberView', {'added_us': 'int', 'champion': 'Union[int, None]', 'method': 'Union[str, None]', 'ship': 'str'}, total=False)
Mirror = Any  # Transformation of a parameter when the ship is mirrored port to starbo
Model = TypedDict('Model', {'branch': 'Union[CorrectionDocument, None]', 'coefficients': 'Dict[str, Quantity]', 'effects': 'List[AppliedEffect]', 'kind': 'ModelKind', 'law': 'str', 'name': 'str', 'note': 'Union[str, None]', 'parameters': 'Dict[str, Quantity]', 'particulars': 'Dict[str, Quantity]', 'posterior': 'Union[Posterior, None]', 'propulsion': 'Union[Propulsion, None]', 'revolutions_loss': 'Union[float, None]', 'revolutions_rps': 'Union[float, None]', 'ship': 'str', 'sources': 'Dict[str, Source]', 'speed_m_s': 'Union[float, None]', 'status': 'Status', 'steering': 'Steering', 'uncertainty': 'Union[Uncertainty, None]', 'validity': 'Union[Region, None]'}, total=False)
ModelKind = Any  # The word `model`.
ModelValidity = Any  # Validity of a model.
NewFamily = TypedDict('NewFamily', {'foundation': 'str', 'members': 'List[str]', 'name': 'str', 'title': 'Union[str, None]'}, total=False)
NewFoundation = TypedDict('NewFoundation', {'foundation': 'str'}, total=True)
NewKeyView = TypedDict('NewKeyView', {'about': 'KeyView', 'key': 'str'}, total=True)
NewMembers = TypedDict('NewMembers', {'ships': 'List[str]'}, total=True)
NewNote = TypedDict('NewNote', {'text': 'str'}, total=True)
NewWebhookView = TypedDict('NewWebhookView', {'about': 'WebhookView', 'secret': 'str'}, total=True)
NoteReceipt = TypedDict('NoteReceipt', {'ship': 'str', 'text': 'str'}, total=True)
NoteView = TypedDict('NoteView', {'actor': 'str', 'at_us': 'int', 'number': 'int', 'text': 'str'}, total=True)
NumberOrExpression = Any  # 
OrdersRequest = TypedDict('OrdersRequest', {'delta_rad': 'Union[float, None]', 'inputs': 'Dict[str, float]', 'n_rps': 'Union[float, None]'}, total=False)
OutcomeView = TypedDict('OutcomeView', {'comparison': 'Dict[str, Any]', 'outcome': 'str', 'ship': 'str', 'version': 'Union[int, None]', 'worst_change': 'Union[float, None]'}, total=False)
ParticularsRequest = TypedDict('ParticularsRequest', {'citation': 'str', 'values': 'Dict[str, Union[float, None]]'}, total=True)
PasswordRequest = TypedDict('PasswordRequest', {'password': 'str'}, total=True)
Posterior = TypedDict('Posterior', {'deviations': 'List[float]', 'names': 'List[str]', 'root_correlation': 'List[str]', 'values': 'List[float]'}, total=True)
PredictionRequest = TypedDict('PredictionRequest', {'depth_m': 'Union[float, None]', 'horizon': 'Union[HorizonRequest, None]', 'inputs': 'Union[InputsRequest, None]', 'manoeuvre': 'Union[ManoeuvreRequest, None]', 'model': 'str'}, total=False)
Prior = Any  # Mean of the prior.
PriorChoice = Any  # Prior of the coefficients.
PriorFile = TypedDict('PriorFile', {'deviation': 'float', 'mean': 'float'}, total=False)
PriorView = TypedDict('PriorView', {'created_us': 'int', 'document': 'Dict[str, Any]', 'family': 'str', 'revision': 'int', 'sha256': 'str'}, total=True)
Problem = TypedDict('Problem', {'detail': 'str', 'errors': 'List[Fault]', 'instance': 'Union[str, None]', 'status': 'int', 'title': 'str', 'type': 'str'}, total=False)
Promotion = TypedDict('Promotion', {'actor': 'str', 'reason': 'str', 'ships': 'Union[List[str], None]'}, total=False)
PromotionResult = TypedDict('PromotionResult', {'champions': 'int'}, total=True)
Propulsion = TypedDict('Propulsion', {'parameters': 'Dict[str, Quantity]'}, total=True)
PublishedModelFile = TypedDict('PublishedModelFile', {'coefficients': 'Section', 'law': 'str', 'name': 'str', 'note': 'Union[str, None]', 'parameters': 'Section', 'revolutions_rps': 'Union[float, None]', 'speed_m_s': 'Union[float, None]', 'status': 'Status', 'steering': 'Steering'}, total=False)
PublishedTurn = TypedDict('PublishedTurn', {'advance': 'Union[float, None]', 'both_sides': 'bool', 'rudder_deg': 'float', 'steady_radius': 'Union[float, None]', 'tactical_diameter': 'Union[float, None]', 'transfer': 'Union[float, None]', 'uncertainty': 'float'}, total=False)
PublishedZigzag = TypedDict('PublishedZigzag', {'both_sides': 'bool', 'first_overshoot_deg': 'Union[float, None]', 'rudder_deg': 'float', 'second_overshoot_deg': 'Union[float, None]', 'switch_deg': 'float', 'uncertainty_deg': 'float'}, total=False)
Quantity = TypedDict('Quantity', {'note': 'Union[str, None]', 'source': 'str', 'standard_error': 'Union[float, None]', 'value': 'float'}, total=False)
QuotedVectorFile = TypedDict('QuotedVectorFile', {'note': 'Union[str, None]', 'source': 'str', 'values': 'Dict[str, ValueEntry]'}, total=False)
RecentDrift = TypedDict('RecentDrift', {'axis': 'str', 'ratio': 'float', 'since': 'Union[str, None]'}, total=False)
RefinementRequest = TypedDict('RefinementRequest', {'law': 'Union[str, None]', 'settings': 'RefinementSettings', 'ship': 'str', 'source': 'Union[str, None]', 'trials': 'Union[List[str], None]'}, total=False)
RefinementSettings = TypedDict('RefinementSettings', {'algorithm_revision': 'int', 'bands': 'Sampling', 'calibration_samples': 'Union[int, None]', 'cma_es': 'Union[CmaEs, None]', 'constraints': 'Constraints', 'difference_s': 'Union[float, None]', 'families': 'List[TermFamily]', 'folds': 'int', 'held_out': 'List[str]', 'hold_out_parts': 'bool', 'hop_s': 'Union[float, None]', 'lambda_count': 'int', 'longer_restarts_s': 'List[float]', 'method': 'Estimator', 'mixture_positions': 'List[float]', 'part_s': 'Union[float, None]', 'prior': 'Prior', 'ranges': 'List[TuningRange]', 'regressions_sha256': 'Union[str, None]', 'residual_s': 'Union[float, None]', 'restart_s': 'Union[float, None]', 'roll_strength': 'Union[float, None]', 'segment_s': 'Union[float, None]', 'smoothing_s': 'Union[float, None]', 'step_s': 'Union[float, None]', 'strengths': 'List[float]', 'window_s': 'Union[float, None]'}, total=False)
Region = TypedDict('Region', {'environment': 'Dict[str, List[float]]', 'pairs': 'Dict[str, List[float]]', 'ranges': 'Dict[str, List[float]]'}, total=False)
RegisterRequest = TypedDict('RegisterRequest', {'model': 'Model', 'origin': 'str', 'parent': 'Union[int, None]'}, total=False)
RoleName = Any  # Role of a user or key; each includes the rights of those before it.
RoleRequest = TypedDict('RoleRequest', {'family': 'Union[str, None]', 'role': 'RoleName', 'ship': 'Union[str, None]'}, total=False)
RoleView = TypedDict('RoleView', {'family': 'Union[str, None]', 'role': 'str', 'ship': 'Union[str, None]'}, total=False)
RolesRequest = TypedDict('RolesRequest', {'roles': 'List[RoleRequest]'}, total=True)
Rotation = Any  # Direction of rotation seen from aft.
RudderSign = Any  # Direction in which positive rudder turns the ship.
Rule = TypedDict('Rule', {'no_worse_than': 'Union[float, None]'}, total=False)
Sampling = TypedDict('Sampling', {'samples': 'int', 'seed': 'int'}, total=False)
Section = TypedDict('Section', {'source': 'Union[str, None]', 'values': 'Dict[str, ValueEntry]'}, total=False)
SessionRequest = TypedDict('SessionRequest', {'current': 'Union[CurrentRequest, None]', 'delta_rad': 'float', 'depth_m': 'Union[float, None]', 'draws': 'Union[int, None]', 'model': 'str', 'seed': 'Union[int, None]', 'start': 'Union[InitialState, None]', 'wind': 'Union[WindRequest, None]'}, total=False)
Settings = TypedDict('Settings', {'public_url': 'Union[str, None]', 'second_person': 'bool'}, total=False)
SettingsRequest = TypedDict('SettingsRequest', {'public_url': 'Union[str, None]', 'second_person': 'bool'}, total=False)
ShipDetail = TypedDict('ShipDetail', {'category': 'str', 'condition': 'Condition', 'created_us': 'int', 'document': 'Dict[str, Any]', 'name': 'str', 'revision': 'int', 'title': 'str', 'updated_us': 'int'}, total=True)
ShipHead = TypedDict('ShipHead', {'category': 'str', 'created_us': 'int', 'name': 'str', 'revision': 'int', 'title': 'str', 'updated_us': 'int', 'value': 'Union[float, None]'}, total=False)
Signal = Any  # Signals that may be inputs of a learned correction.
SignatureList = TypedDict('SignatureList', {'author': 'str', 'created_us': 'int', 'signatures': 'List[SignatureView]'}, total=True)
SignatureReceipt = TypedDict('SignatureReceipt', {'model': 'str', 'number': 'int', 'person': 'str', 'role': 'str'}, total=True)
SignatureRequest = TypedDict('SignatureRequest', {'person': 'str', 'role': 'SignatureRole'}, total=True)
SignatureRole = Any  # Role in which a person signs.
SignatureView = TypedDict('SignatureView', {'actor': 'str', 'at_us': 'int', 'person': 'str', 'role': 'str'}, total=True)
SinceTrial = TypedDict('SinceTrial', {'at_us': 'int', 'name': 'str', 'trial': 'str'}, total=True)
Source = TypedDict('Source', {'citation': 'str', 'doi': 'Union[str, None]', 'note': 'Union[str, None]'}, total=False)
Start = Any  # Starting model of a member.
Status = Any  # Origin of a model's figures, and thus the trust that they deserve.
Steering = TypedDict('Steering', {'limit_deg': 'float', 'note': 'Union[str, None]', 'rate_deg_s': 'float', 'source': 'Union[str, None]', 'time_constant_s': 'float'}, total=False)
StepsRequest = TypedDict('StepsRequest', {'dt_s': 'float', 'orders': 'OrdersRequest', 'steps': 'Union[int, None]'}, total=False)
StraightLine = Any  # Behaviour of a ship after a small disturbance with the rudder amidship
TermFamily = Any  # A set of terms among which model selection chooses.
TimedOrders = TypedDict('TimedOrders', {'delta_rad': 'Union[float, None]', 'n_rps': 'Union[float, None]', 't_s': 'float'}, total=False)
TrialError = TypedDict('TrialError', {'reason': 'Union[str, None]', 'rmse': 'Dict[str, float]', 'standardised_mse': 'Union[float, None]'}, total=False)
TrialResidual = TypedDict('TrialResidual', {'at_us': 'int', 'fitted': 'bool', 'name': 'str', 'residual': 'Dict[str, float]', 'trial': 'str'}, total=True)
TrialView = TypedDict('TrialView', {'created_us': 'int', 'duration_s': 'float', 'id': 'str', 'manifest': 'Dict[str, Any]', 'manoeuvre': 'Union[str, None]', 'name': 'str', 'rows': 'int', 'sha256': 'str', 'ship': 'str', 'warnings': 'List[Dict[str, Any]]'}, total=False)
TuningRange = TypedDict('TuningRange', {'alpha_max': 'float', 'lambda_max': 'float', 'lambda_min': 'float'}, total=True)
Uncertainty = TypedDict('Uncertainty', {'discrepancy': 'Dict[str, Discrepancy]', 'false_alarm_levels': 'Dict[str, FalseAlarmLevel]', 'instruments': 'Dict[str, InstrumentFit]', 'names': 'List[str]', 'offset': 'List[float]', 'reading_interval_s': 'float', 'remainder': 'Dict[str, float]', 'root_information': 'List[str]', 'scales': 'List[float]', 'systematic_errors': 'List[AppliedEffect]', 'trials': 'List[str]'}, total=False)
UploadResult = TypedDict('UploadResult', {'diagnosis': 'Union[str, None]', 'new': 'int', 'ship': 'str', 'trials': 'List[TrialView]'}, total=False)
UserRequest = TypedDict('UserRequest', {'name': 'str', 'password': 'Union[str, None]', 'roles': 'List[RoleRequest]', 'title': 'Union[str, None]'}, total=False)
UserView = TypedDict('UserView', {'created_us': 'int', 'enabled': 'bool', 'has_password': 'bool', 'identities': 'List[IdentityView]', 'name': 'str', 'roles': 'List[RoleView]', 'title': 'str'}, total=True)
ValidatedQuantity = TypedDict('ValidatedQuantity', {'comparison_error': 'Union[float, None]', 'comparison_error_percent': 'Union[float, None]', 'data': 'float', 'data_from': 'str', 'data_uncertainty': 'Union[float, None]', 'input_uncertainty': 'Union[float, None]', 'quantity': 'str', 'records': 'Union[int, None]', 'simulated': 'Union[float, None]', 'step_uncertainty': 'Union[float, None]', 'unit': 'str', 'validation_uncertainty': 'Union[float, None]', 'validation_uncertainty_percent': 'Union[float, None]', 'verdict': 'Verdict'}, total=False)
Validation = TypedDict('Validation', {'draws': 'int', 'law': 'str', 'model': 'str', 'procedure': 'str', 'quantities': 'List[ValidatedQuantity]', 'remarks': 'List[str]'}, total=True)
ValueEntry = Any  # A value in a file.
ValueWithSource = TypedDict('ValueWithSource', {'note': 'Union[str, None]', 'source': 'Union[str, None]', 'standard_error': 'Union[float, None]', 'value': 'NumberOrExpression'}, total=False)
Verdict = Any  # Verdict of a comparison.
Verification = TypedDict('Verification', {'checked_by': 'str', 'derived_sha256': 'str', 'identical': 'bool', 'made_by': 'Union[str, None]', 'model': 'str', 'number': 'int', 'remarks': 'List[str]', 'sha256': 'str', 'stored_sha256': 'str'}, total=False)
VersionDetail = TypedDict('VersionDetail', {'document': 'Dict[str, Any]', 'version': 'VersionHead'}, total=True)
VersionHead = TypedDict('VersionHead', {'author': 'str', 'created_us': 'int', 'id': 'str', 'law': 'str', 'method': 'str', 'model': 'str', 'number': 'int', 'parent': 'Union[str, None]', 'report': 'Union[str, None]', 'sha256': 'str'}, total=False)
VersionWithEffects = TypedDict('VersionWithEffects', {'at': 'str', 'number': 'int'}, total=True)
VesselConventions = TypedDict('VesselConventions', {'rudder_positive': 'RudderSign'}, total=False)
VesselFile = TypedDict('VesselFile', {'actuators': 'Dict[str, Actuator]', 'category': 'str', 'conventions': 'VesselConventions', 'free_running': 'List[FreeRunning]', 'kind': 'VesselKind', 'licences': 'Dict[str, str]', 'models': 'List[PublishedModelFile]', 'name': 'str', 'particulars': 'Section', 'quoted_vectors': 'Dict[str, QuotedVectorFile]', 'scale': 'Union[float, None]', 'sources': 'Dict[str, Source]', 'title': 'str', 'type': 'Union[str, None]'}, total=False)
VesselKind = Any  # The word `vessel`.
WebhookEvent = Any  # Event of which webhooks are notified.
WebhookRequest = TypedDict('WebhookRequest', {'drift_above': 'Union[float, None]', 'events': 'List[WebhookEvent]', 'ship': 'Union[str, None]', 'title': 'str', 'url': 'str'}, total=False)
WebhookView = TypedDict('WebhookView', {'created_us': 'int', 'drift_above': 'float', 'ended_us': 'Union[int, None]', 'events': 'List[str]', 'id': 'str', 'ship': 'Union[str, None]', 'title': 'str', 'url': 'str'}, total=False)
WeighedDiagnosis = Any  # A diagnosis that counts.
WindRequest = TypedDict('WindRequest', {'from_rad': 'float', 'speed_m_s': 'float'}, total=True)
ZigzagRequest = TypedDict('ZigzagRequest', {'rudder_deg': 'float', 'switch_deg': 'float'}, total=True)


class Core:
    """Every operation by its name."""

    def __init__(self, http: Http) -> None:
        self.http = http

    def get_healthz(self) -> Health:
        """Check that the server is running."""
        return self.http.json('GET', '/healthz')

    def get_metrics(self) -> bytes:
        """Get requests by route and status, their duration, jobs by kind and state, the queue's age, and the object store's size."""
        return self.http.bytes('GET', '/metrics')

    def get_readyz(self) -> Health:
        """Check that the server can work: its database and its object store answer, and it is not stopping."""
        return self.http.json('GET', '/readyz')

    def get_audit(self, *, actor: Optional[str] = None, subject: Optional[str] = None, limit: Optional[int] = None, after: Optional[str] = None) -> Listing_EntryView:
        """List the entries of the audit, the latest first."""
        return self.http.json('GET', '/v1/audit', query={'actor': actor, 'subject': subject, 'limit': limit, 'after': after})

    def get_audit_head(self) -> HeadView:
        """Get the number and the hash of the last entry of the audit."""
        return self.http.json('GET', '/v1/audit/head')

    def post_branches(self, body: BranchRequest, *, idempotency_key: Optional[str] = None) -> JobView:
        """Train a learned correction of a version."""
        return self.http.json('POST', '/v1/branches', headers={'Idempotency-Key': idempotency_key}, json=body)

    def get_bulk_refinements(self, *, family: Optional[str] = None, limit: Optional[int] = None, after: Optional[str] = None) -> Listing_BulkView:
        """List the bulk refinements, the latest first."""
        return self.http.json('GET', '/v1/bulk-refinements', query={'family': family, 'limit': limit, 'after': after})

    def delete_bulk_refinements_id(self, id: str) -> BulkView:
        """Cancel the rest of a bulk refinement; ships that are done keep their outcome."""
        return self.http.json('DELETE', f'/v1/bulk-refinements/{id}')

    def get_bulk_refinements_id(self, id: str) -> BulkView:
        """Get the state of a bulk refinement."""
        return self.http.json('GET', f'/v1/bulk-refinements/{id}')

    def post_bulk_refinements_id_champions(self, id: str, body: Promotion) -> PromotionResult:
        """Promote candidates of a bulk refinement to champions."""
        return self.http.json('POST', f'/v1/bulk-refinements/{id}/champions', json=body)

    def post_bulk_refinements_id_retry(self, id: str) -> BulkView:
        """Run the chunks again that failed or were cancelled."""
        return self.http.json('POST', f'/v1/bulk-refinements/{id}/retry')

    def get_bulk_refinements_id_ships(self, id: str, *, outcome: Optional[Literal['champion', 'candidate', 'unchanged', 'refused']] = None, limit: Optional[int] = None, after: Optional[str] = None) -> Listing_OutcomeView:
        """List the ships of a bulk refinement with their errors before and after."""
        return self.http.json('GET', f'/v1/bulk-refinements/{id}/ships', query={'outcome': outcome, 'limit': limit, 'after': after})

    def get_compare(self, *, version: Optional[List[str]] = None, trial: Optional[List[str]] = None) -> Comparison:
        """Compare two to five versions."""
        return self.http.json('GET', '/v1/compare', query={'version': version, 'trial': trial})

    def post_diagnoses(self, body: DiagnosisRequest, *, idempotency_key: Optional[str] = None) -> JobView:
        """Diagnose what effects a model lacks."""
        return self.http.json('POST', '/v1/diagnoses', headers={'Idempotency-Key': idempotency_key}, json=body)

    def get_effects(self, *, limit: Optional[int] = None, after: Optional[str] = None) -> Listing_EffectLibraryHead:
        """List the libraries of effects, by hash."""
        return self.http.json('GET', '/v1/effects', query={'limit': limit, 'after': after})

    def get_effects_sha256(self, sha256: str) -> bytes:
        """Get a library of effects: the YAML files of its effects in sequence, byte for byte as they were hashed."""
        return self.http.bytes('GET', f'/v1/effects/{sha256}')

    def get_families(self, *, limit: Optional[int] = None, after: Optional[str] = None) -> Listing_FamilyView:
        """List the families by name."""
        return self.http.json('GET', '/v1/families', query={'limit': limit, 'after': after})

    def post_families(self, body: NewFamily, *, idempotency_key: Optional[str] = None) -> FamilyView:
        """Create a family on a foundation."""
        return self.http.json('POST', '/v1/families', headers={'Idempotency-Key': idempotency_key}, json=body)

    def get_families_family(self, family: str) -> FamilyView:
        """Get a family."""
        return self.http.json('GET', f'/v1/families/{family}')

    def put_families_family(self, family: str, body: NewFoundation) -> FamilyView:
        """Replace the foundation of a family; models are refined from it when the family is refined next."""
        return self.http.json('PUT', f'/v1/families/{family}', json=body)

    def get_families_family_drift(self, family: str, *, limit: Optional[int] = None) -> FamilyDrift:
        """List the ships of a family whose model no longer holds, the worst first, with the effects that their diagnosis names."""
        return self.http.json('GET', f'/v1/families/{family}/drift', query={'limit': limit})

    def get_families_family_members(self, family: str, *, limit: Optional[int] = None, after: Optional[str] = None) -> Listing_MemberView:
        """List the members of a family by name."""
        return self.http.json('GET', f'/v1/families/{family}/members', query={'limit': limit, 'after': after})

    def post_families_family_members(self, family: str, body: NewMembers) -> FamilyView:
        """Add ships to a family, all or none; members stay members."""
        return self.http.json('POST', f'/v1/families/{family}/members', json=body)

    def delete_families_family_members_ship(self, family: str, ship: str) -> FamilyView:
        """Remove a ship from a family."""
        return self.http.json('DELETE', f'/v1/families/{family}/members/{ship}')

    def get_families_family_prior(self, family: str, *, revision: Optional[int] = None) -> PriorView:
        """Get the prior of a family: the variation of each coefficient over its members."""
        return self.http.json('GET', f'/v1/families/{family}/prior', query={'revision': revision})

    def post_families_family_prior(self, family: str) -> JobView:
        """Learn the variation of the coefficients from the members' trials; the work is a job."""
        return self.http.json('POST', f'/v1/families/{family}/prior')

    def post_families_family_refinements(self, family: str, body: BulkRefinementRequest, *, idempotency_key: Optional[str] = None) -> BulkView:
        """Refine every member of a family from the statistics of its trials."""
        return self.http.json('POST', f'/v1/families/{family}/refinements', headers={'Idempotency-Key': idempotency_key}, json=body)

    def delete_jobs(self, *, ship: Optional[str] = None) -> CancelledJobs:
        """Cancel all of the caller's jobs that wait or run, of one ship if it is named."""
        return self.http.json('DELETE', '/v1/jobs', query={'ship': ship})

    def get_jobs(self, *, ship: Optional[str] = None, state: Optional[Literal['queued', 'running', 'succeeded', 'failed', 'cancelled']] = None, limit: Optional[int] = None, after: Optional[str] = None) -> Listing_JobView:
        """List the jobs, the latest first."""
        return self.http.json('GET', '/v1/jobs', query={'ship': ship, 'state': state, 'limit': limit, 'after': after})

    def delete_jobs_id(self, id: str) -> JobView:
        """Cancel a job; a running one stops at its next step."""
        return self.http.json('DELETE', f'/v1/jobs/{id}')

    def get_jobs_id(self, id: str) -> JobView:
        """Get a job."""
        return self.http.json('GET', f'/v1/jobs/{id}')

    def get_jobs_id_events(self, id: str) -> bytes:
        """Follow a job until its end."""
        return self.http.bytes('GET', f'/v1/jobs/{id}/events')

    def post_jobs_id_retry(self, id: str) -> JobView:
        """Run a job again that failed or was cancelled."""
        return self.http.json('POST', f'/v1/jobs/{id}/retry')

    def get_keys(self, *, limit: Optional[int] = None, after: Optional[str] = None) -> Listing_KeyView:
        """List the service keys by prefix, including ended ones."""
        return self.http.json('GET', '/v1/keys', query={'limit': limit, 'after': after})

    def post_keys(self, body: KeyRequest) -> NewKeyView:
        """Create a service key."""
        return self.http.json('POST', '/v1/keys', json=body)

    def delete_keys_prefix(self, prefix: str) -> KeyView:
        """Revoke a service key permanently."""
        return self.http.json('DELETE', f'/v1/keys/{prefix}')

    def get_keys_prefix(self, prefix: str) -> KeyView:
        """Get a service key."""
        return self.http.json('GET', f'/v1/keys/{prefix}')

    def put_keys_prefix_roles(self, prefix: str, body: RolesRequest) -> KeyView:
        """Replace all roles of a service key."""
        return self.http.json('PUT', f'/v1/keys/{prefix}/roles', json=body)

    def get_laws(self, *, limit: Optional[int] = None, after: Optional[str] = None) -> Listing_LawHead:
        """List the laws."""
        return self.http.json('GET', '/v1/laws', query={'limit': limit, 'after': after})

    def post_laws(self, body: bytes, media: str, *, idempotency_key: Optional[str] = None) -> LawHead:
        """Add a law; it never changes afterwards."""
        return self.http.json('POST', '/v1/laws', headers={'Idempotency-Key': idempotency_key}, body=body, media=media)

    def get_laws_law(self, law: str) -> LawText:
        """Get a law, as JSON or as its YAML file."""
        return self.http.json('GET', f'/v1/laws/{law}')

    def get_me(self) -> Me:
        """Get the caller and its roles."""
        return self.http.json('GET', '/v1/me')

    def get_models_model_aliases(self, model: str, *, limit: Optional[int] = None, after: Optional[str] = None) -> Listing_AliasView:
        """List the aliases of a model."""
        return self.http.json('GET', f'/v1/models/{model}/aliases', query={'limit': limit, 'after': after})

    def get_models_model_aliases_alias(self, model: str, alias: str) -> AliasView:
        """Get the position of an alias; a move must present its ETag."""
        return self.http.json('GET', f'/v1/models/{model}/aliases/{alias}')

    def put_models_model_aliases_alias(self, model: str, alias: str, body: AliasRequest, *, if_match: Optional[str] = None, if_none_match: Optional[str] = None) -> AliasView:
        """Move an alias, or create it."""
        return self.http.json('PUT', f'/v1/models/{model}/aliases/{alias}', headers={'If-Match': if_match, 'If-None-Match': if_none_match}, json=body)

    def get_models_model_aliases_alias_history(self, model: str, alias: str, *, limit: Optional[int] = None, after: Optional[str] = None) -> Listing_AliasStep:
        """List the moves of an alias, the latest first."""
        return self.http.json('GET', f'/v1/models/{model}/aliases/{alias}/history', query={'limit': limit, 'after': after})

    def get_models_model_versions(self, model: str, *, limit: Optional[int] = None, after: Optional[str] = None) -> Listing_VersionHead:
        """List the versions of a model, the latest first."""
        return self.http.json('GET', f'/v1/models/{model}/versions', query={'limit': limit, 'after': after})

    def post_models_model_versions(self, model: str, body: RegisterRequest, *, idempotency_key: Optional[str] = None) -> VersionHead:
        """Register a model that was made elsewhere as the next version."""
        return self.http.json('POST', f'/v1/models/{model}/versions', headers={'Idempotency-Key': idempotency_key}, json=body)

    def get_models_model_versions_number(self, model: str, number: int) -> VersionDetail:
        """Get a version with its document."""
        return self.http.json('GET', f'/v1/models/{model}/versions/{number}')

    def get_models_model_versions_number_document(self, model: str, number: int, *, if_none_match: Optional[str] = None) -> Dict[str, Any]:
        """Get the document of a version, byte for byte as it was hashed."""
        return self.http.json('GET', f'/v1/models/{model}/versions/{number}/document', headers={'If-None-Match': if_none_match})

    def get_models_model_versions_number_export(self, model: str, number: int, *, format: Optional[Literal['c', 'python', 'matlab', 'modelica', 'fmu2', 'fmu3', 'ssp']] = None) -> bytes:
        """Export a version as a file for another tool."""
        return self.http.bytes('GET', f'/v1/models/{model}/versions/{number}/export', query={'format': format})

    def get_models_model_versions_number_signatures(self, model: str, number: int) -> SignatureList:
        """Get the signatures under a version."""
        return self.http.json('GET', f'/v1/models/{model}/versions/{number}/signatures')

    def post_models_model_versions_number_signatures(self, model: str, number: int, body: SignatureRequest, *, idempotency_key: Optional[str] = None) -> SignatureReceipt:
        """Sign a version as checked or approved."""
        return self.http.json('POST', f'/v1/models/{model}/versions/{number}/signatures', headers={'Idempotency-Key': idempotency_key}, json=body)

    def get_models_model_versions_number_validation(self, model: str, number: int, *, format: Optional[Literal['json', 'html']] = None) -> Validation:
        """Validate a version after ITTC 7.5-02-06-03."""
        return self.http.json('GET', f'/v1/models/{model}/versions/{number}/validation', query={'format': format})

    def post_models_model_versions_number_verify(self, model: str, number: int) -> Verification:
        """Derive a version again from its recipe, and compare the bytes."""
        return self.http.json('POST', f'/v1/models/{model}/versions/{number}/verify')

    def get_models_model_versions_number_weights(self, model: str, number: int) -> Dict[str, Any]:
        """Get the weights of a version's learned correction."""
        return self.http.json('GET', f'/v1/models/{model}/versions/{number}/weights')

    def post_predictions(self, body: PredictionRequest) -> Dict[str, Any]:
        """Simulate a manoeuvre, recorded inputs, or future orders, with a version of a model."""
        return self.http.json('POST', '/v1/predictions', json=body)

    def post_refinements(self, body: RefinementRequest, *, idempotency_key: Optional[str] = None) -> JobView:
        """Refine a model against trials."""
        return self.http.json('POST', '/v1/refinements', headers={'Idempotency-Key': idempotency_key}, json=body)

    def get_reports_id(self, id: str, *, format: Optional[Literal['json', 'html']] = None) -> Dict[str, Any]:
        """Get a report, as JSON or as a self-contained page."""
        return self.http.json('GET', f'/v1/reports/{id}', query={'format': format})

    def get_sessions(self) -> Dict[str, Any]:
        """List the caller's sessions."""
        return self.http.json('GET', '/v1/sessions')

    def post_sessions(self, body: SessionRequest) -> Dict[str, Any]:
        """Open a simulation session."""
        return self.http.json('POST', '/v1/sessions', json=body)

    def delete_sessions_id(self, id: str) -> None:
        """End a session."""
        return self.http.none('DELETE', f'/v1/sessions/{id}')

    def get_sessions_id(self, id: str) -> Dict[str, Any]:
        """Get the present state of a session."""
        return self.http.json('GET', f'/v1/sessions/{id}')

    def post_sessions_id_steps(self, id: str, body: StepsRequest) -> Dict[str, Any]:
        """Advance a session by steps."""
        return self.http.json('POST', f'/v1/sessions/{id}/steps', json=body)

    def get_sessions_id_stream(self, id: str) -> None:
        """Advance a session over a WebSocket."""
        return self.http.none('GET', f'/v1/sessions/{id}/stream')

    def get_settings(self) -> Settings:
        """Get the settings that apply to every process on the store."""
        return self.http.json('GET', '/v1/settings')

    def put_settings(self, body: SettingsRequest) -> Settings:
        """Change the settings."""
        return self.http.json('PUT', '/v1/settings', json=body)

    def get_ships(self, *, limit: Optional[int] = None, after: Optional[str] = None, category: Optional[str] = None, tag: Optional[str] = None, particular: Optional[List[str]] = None, metric: Optional[List[str]] = None, similar_to: Optional[str] = None, vector: Optional[Literal['mei-2019', 'kanazawa-2023']] = None) -> Listing_ShipHead:
        """Find ships: by category, tag, particulars, metrics of the champion, and similarity."""
        return self.http.json('GET', '/v1/ships', query={'limit': limit, 'after': after, 'category': category, 'tag': tag, 'particular': particular, 'metric': metric, 'similar_to': similar_to, 'vector': vector})

    def post_ships(self, body: VesselFile, *, idempotency_key: Optional[str] = None) -> ShipDetail:
        """Create a ship."""
        return self.http.json('POST', '/v1/ships', headers={'Idempotency-Key': idempotency_key}, json=body)

    def delete_ships_ship(self, ship: str, *, if_match: Optional[str] = None) -> None:
        """Delete a ship; its versions stay, and `undelete` restores it."""
        return self.http.none('DELETE', f'/v1/ships/{ship}', headers={'If-Match': if_match})

    def get_ships_ship(self, ship: str, *, if_none_match: Optional[str] = None) -> ShipDetail:
        """Get a ship; a change must present its ETag."""
        return self.http.json('GET', f'/v1/ships/{ship}', headers={'If-None-Match': if_none_match})

    def put_ships_ship(self, ship: str, body: VesselFile, *, if_match: Optional[str] = None) -> ShipDetail:
        """Replace a ship's document, if it is as you last read it."""
        return self.http.json('PUT', f'/v1/ships/{ship}', headers={'If-Match': if_match}, json=body)

    def get_ships_ship_drift(self, ship: str) -> Drift:
        """Get the unexplained force of a ship's champion in each of its trials, over time."""
        return self.http.json('GET', f'/v1/ships/{ship}/drift')

    def get_ships_ship_model(self, ship: str, *, format: Optional[Literal['json', 'yaml']] = None, if_none_match: Optional[str] = None) -> Champion:
        """Get the model of a ship: its champion."""
        return self.http.json('GET', f'/v1/ships/{ship}/model', query={'format': format}, headers={'If-None-Match': if_none_match})

    def get_ships_ship_notes(self, ship: str, *, limit: Optional[int] = None, after: Optional[str] = None) -> Listing_NoteView:
        """List the notes about a ship, the latest first."""
        return self.http.json('GET', f'/v1/ships/{ship}/notes', query={'limit': limit, 'after': after})

    def post_ships_ship_notes(self, ship: str, body: NewNote, *, idempotency_key: Optional[str] = None) -> NoteReceipt:
        """Add a note about a ship; notes are part of the audit and cannot be removed."""
        return self.http.json('POST', f'/v1/ships/{ship}/notes', headers={'Idempotency-Key': idempotency_key}, json=body)

    def put_ships_ship_particulars(self, ship: str, body: ParticularsRequest, *, if_match: Optional[str] = None) -> ShipDetail:
        """Change particulars of a ship, if it is as you last read it."""
        return self.http.json('PUT', f'/v1/ships/{ship}/particulars', headers={'If-Match': if_match}, json=body)

    def get_ships_ship_similar(self, ship: str, *, vector: Optional[Literal['mei-2019', 'kanazawa-2023']] = None, trials: Optional[bool] = None) -> Dict[str, Any]:
        """Rank the zoo by similarity to a ship, with the eligible source models."""
        return self.http.json('GET', f'/v1/ships/{ship}/similar', query={'vector': vector, 'trials': trials})

    def get_ships_ship_tags(self, ship: str) -> List[str]:
        """List the tags of a ship, in alphabetical order, at most 100."""
        return self.http.json('GET', f'/v1/ships/{ship}/tags')

    def delete_ships_ship_tags_tag(self, ship: str, tag: str) -> None:
        """Remove a tag from a ship."""
        return self.http.none('DELETE', f'/v1/ships/{ship}/tags/{tag}')

    def put_ships_ship_tags_tag(self, ship: str, tag: str) -> None:
        """Add a tag to a ship, by which it can be found."""
        return self.http.none('PUT', f'/v1/ships/{ship}/tags/{tag}')

    def post_ships_ship_undelete(self, ship: str) -> ShipDetail:
        """Restore a deleted ship."""
        return self.http.json('POST', f'/v1/ships/{ship}/undelete')

    def get_trials(self, *, ship: Optional[str] = None, limit: Optional[int] = None, after: Optional[str] = None) -> Listing_TrialView:
        """List the trials of a ship, in the order of their upload."""
        return self.http.json('GET', '/v1/trials', query={'ship': ship, 'limit': limit, 'after': after})

    def post_trials(self, body: bytes, media: str, *, ship: Optional[str] = None, name: Optional[str] = None, manoeuvre: Optional[str] = None, depth_m: Optional[float] = None, n_rps: Optional[float] = None, current_north_m_s: Optional[float] = None, current_east_m_s: Optional[float] = None, diagnose: Optional[bool] = None, idempotency_key: Optional[str] = None) -> UploadResult:
        """Upload trials, all together or none."""
        return self.http.json('POST', '/v1/trials', query={'ship': ship, 'name': name, 'manoeuvre': manoeuvre, 'depth_m': depth_m, 'n_rps': n_rps, 'current_north_m_s': current_north_m_s, 'current_east_m_s': current_east_m_s, 'diagnose': diagnose}, headers={'Idempotency-Key': idempotency_key}, body=body, media=media)

    def post_trials_check(self, body: bytes, media: str, *, ship: Optional[str] = None, name: Optional[str] = None, manoeuvre: Optional[str] = None, depth_m: Optional[float] = None, n_rps: Optional[float] = None, current_north_m_s: Optional[float] = None, current_east_m_s: Optional[float] = None, diagnose: Optional[bool] = None) -> Dict[str, Any]:
        """Check trials without storing them."""
        return self.http.json('POST', '/v1/trials/check', query={'ship': ship, 'name': name, 'manoeuvre': manoeuvre, 'depth_m': depth_m, 'n_rps': n_rps, 'current_north_m_s': current_north_m_s, 'current_east_m_s': current_east_m_s, 'diagnose': diagnose}, body=body, media=media)

    def delete_trials_id(self, id: str) -> None:
        """Delete a trial; versions that were made with it stay, and `undelete` restores it."""
        return self.http.none('DELETE', f'/v1/trials/{id}')

    def get_trials_id(self, id: str) -> TrialView:
        """Get a trial."""
        return self.http.json('GET', f'/v1/trials/{id}')

    def get_trials_id_conditions(self, id: str) -> ConditionsView:
        """Get the conditions of a trial as they were last stated."""
        return self.http.json('GET', f'/v1/trials/{id}/conditions')

    def put_trials_id_conditions(self, id: str, body: ConditionsRequest) -> ConditionsView:
        """State the conditions of a trial; they replace what was stated before."""
        return self.http.json('PUT', f'/v1/trials/{id}/conditions', json=body)

    def get_trials_id_samples(self, id: str) -> bytes:
        """Get the samples of a trial, as CSV or as Parquet, under canonical names."""
        return self.http.bytes('GET', f'/v1/trials/{id}/samples')

    def post_trials_id_undelete(self, id: str) -> TrialView:
        """Restore a deleted trial."""
        return self.http.json('POST', f'/v1/trials/{id}/undelete')

    def get_users(self, *, limit: Optional[int] = None, after: Optional[str] = None) -> Listing_UserView:
        """List the users by name."""
        return self.http.json('GET', '/v1/users', query={'limit': limit, 'after': after})

    def post_users(self, body: UserRequest, *, idempotency_key: Optional[str] = None) -> UserView:
        """Create a user."""
        return self.http.json('POST', '/v1/users', headers={'Idempotency-Key': idempotency_key}, json=body)

    def delete_users_user(self, user: str) -> UserView:
        """Disable a user: all sessions end and all rights are suspended; the name stays taken."""
        return self.http.json('DELETE', f'/v1/users/{user}')

    def get_users_user(self, user: str) -> UserView:
        """Get a user."""
        return self.http.json('GET', f'/v1/users/{user}')

    def post_users_user_enable(self, user: str) -> UserView:
        """Enable a disabled user, with the same rights as before."""
        return self.http.json('POST', f'/v1/users/{user}/enable')

    def put_users_user_identities(self, user: str, body: IdentitiesRequest) -> UserView:
        """Replace all identities of a user at OpenID providers."""
        return self.http.json('PUT', f'/v1/users/{user}/identities', json=body)

    def put_users_user_password(self, user: str, body: PasswordRequest) -> None:
        """Set the password of a user, which ends all sessions."""
        return self.http.none('PUT', f'/v1/users/{user}/password', json=body)

    def put_users_user_roles(self, user: str, body: RolesRequest) -> UserView:
        """Replace all roles of a user."""
        return self.http.json('PUT', f'/v1/users/{user}/roles', json=body)

    def get_webhooks(self, *, limit: Optional[int] = None, after: Optional[str] = None) -> Listing_WebhookView:
        """List the webhooks by id, including ended ones."""
        return self.http.json('GET', '/v1/webhooks', query={'limit': limit, 'after': after})

    def post_webhooks(self, body: WebhookRequest) -> NewWebhookView:
        """Create a webhook, which notifies a URL of events."""
        return self.http.json('POST', '/v1/webhooks', json=body)

    def delete_webhooks_id(self, id: str) -> WebhookView:
        """Delete a webhook permanently."""
        return self.http.json('DELETE', f'/v1/webhooks/{id}')

    def get_webhooks_id(self, id: str) -> WebhookView:
        """Get a webhook."""
        return self.http.json('GET', f'/v1/webhooks/{id}')

    def get_webhooks_id_deliveries(self, id: str, *, limit: Optional[int] = None, after: Optional[str] = None) -> Listing_DeliveryView:
        """List the deliveries of a webhook, the latest first."""
        return self.http.json('GET', f'/v1/webhooks/{id}/deliveries', query={'limit': limit, 'after': after})

    def post_webhooks_id_deliveries_delivery_retry(self, id: str, delivery: str) -> DeliveryView:
        """Send a delivery again that has not arrived."""
        return self.http.json('POST', f'/v1/webhooks/{id}/deliveries/{delivery}/retry')
