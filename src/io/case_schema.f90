!> The one table of everything a case file can say: groups, keys, kinds, defaults, ranges, units. Reading, checking,
!> the template and the resolved case all follow from it. A range and a list of words are texts, shown to the user as
!> they stand here; a key's own default is allowed even outside its range and then means "not given".
module case_schema
  implicit none
  private
  public :: key_t, group_definition_t, schema_groups, schema_keys, find_key, find_group
  public :: real_kind, integer_kind, logical_kind, word_kind, text_kind

  integer, parameter :: real_kind = 1, integer_kind = 2, logical_kind = 3, word_kind = 4, text_kind = 5

  !> A group. One that stands for a model may be absent from a case, and so the model from its scene.
  type :: group_definition_t
    character(len=12) :: name = ''
    logical :: is_model = .false.
    character(len=100) :: description = ''
  end type group_definition_t

  !> A key.
  type :: key_t
    character(len=12) :: group = ''
    character(len=32) :: name = ''
    integer :: kind = real_kind
    integer :: count = 1                  !! values
    logical :: required = .false.         !! wherever its group is present
    character(len=24) :: default = ''     !! value where it is not given; without quotes; for all of an array
    character(len=24) :: example = ''     !! value in the template, where the default would not do
    character(len=12) :: unit = ''
    character(len=24) :: range = ''
    character(len=64) :: words = ''       !! allowed words, separated by a comma and a blank
    character(len=100) :: description = ''
    character(len=12) :: family = ''      !! of the keys of its group that say one thing in different ways: one alone may be given
  end type key_t

contains

  pure function schema_groups() result(groups)
    type(group_definition_t), allocatable :: groups(:)
    groups = [ &
      group_definition_t('case', .false., 'SI units; angles in degrees only where the key ends in _deg'), &
      group_definition_t('mechanism', .false., 'bodies; centres of mass along and across each body, from its inner pin'), &
      group_definition_t('drive', .false., 'what turns the crank'), &
      group_definition_t('initial', .false., 'start: velocities as with an ideal joint, but for those of the pin in its bearing'), &
      group_definition_t('joint', .false., 'piston-pin joint'), &
      group_definition_t('contact', .true., 'pin against bearing: leave the group out for no contact'), &
      group_definition_t('friction', .true., 'dry friction of the contact: leave the group out for none'), &
      group_definition_t('lubrication', .true., 'oil film in the clearance: leave the group out for a dry joint'), &
      group_definition_t('combustion', .true., 'four-stroke cycle on the piston: leave the group out for none'), &
      group_definition_t('integrator', .false., 'how it is integrated; the run''s end by revolutions or end_time, not both'), &
      group_definition_t('output', .false., 'what is written')]
  end function schema_groups

  !> Every key, in the order of the groups and of the resolved case.
  pure function schema_keys() result(keys)
    type(key_t), allocatable :: keys(:)
    keys = [body_keys(), joint_keys(), model_keys(), combustion_keys(), run_keys()]
  end function schema_keys

  pure function body_keys() result(keys)
    type(key_t), allocatable :: keys(:)
    character(len=*), parameter :: m = 'mechanism'
    keys = [ &
      text_key('case', 'title', '', 'what the case is'), &
      real_key(m, 'crank_length', 'm', '> 0', 'crank pin from crank axis', example='0.0508'), &
      real_key(m, 'crank_mass', 'kg', '>= 0', 'mass', example='0.80'), &
      real_key(m, 'crank_inertia', 'kg m^2', '>= 0', 'moment of inertia about its centre of mass', example='0.006'), &
      real_key(m, 'crank_com', 'm', '', 'centre of mass from the crank axis', default='0.0', count=2), &
      real_key(m, 'rod_length', 'm', '> 0', 'piston pin from crank pin', example='0.2032'), &
      real_key(m, 'rod_mass', 'kg', '>= 0', 'mass', example='1.36'), &
      real_key(m, 'rod_inertia', 'kg m^2', '>= 0', 'moment of inertia about its centre of mass', example='0.010'), &
      real_key(m, 'rod_com', 'm', '', 'centre of mass from the crank pin', default='0.0', count=2), &
      real_key(m, 'piston_mass', 'kg', '> 0', 'mass', example='0.91'), &
      real_key(m, 'gravity', 'm/s^2', '', 'downwards, from the cylinder to the crank', default='9.80665'), &
      word_key('drive', 'kind', 'free', 'free, constant_speed', 'free: the crank turns as the forces make it'), &
      real_key('drive', 'torque', 'N m', '', 'on a free crank, in the sense of its angle', default='0.0'), &
      real_key('drive', 'damping', 'N m s/rad', '>= 0', &
               'moment against the crank speed; at constant_speed it adds to crank_moment alone', default='0.0'), &
      real_key('initial', 'crank_angle_deg', 'degrees', '', 'from the cylinder axis', default='0.0'), &
      real_key('initial', 'crank_speed', 'rad/s', '', 'held there by drive kind constant_speed', example='250.0'), &
      real_key('initial', 'eccentricity', 'm', '', 'pin centre from bearing centre; from the clearance on it touches', &
               default='0.0', count=2), &
      real_key('initial', 'eccentricity_rate', 'm/s', '', 'its rate', default='0.0', count=2)]
  end function body_keys

  pure function joint_keys() result(keys)
    type(key_t), allocatable :: keys(:)
    keys = [ &
      word_key('joint', 'kind', 'ideal', 'ideal, clearance', 'ideal: no play', example='clearance'), &
      real_key('joint', 'clearance', 'm', '> 0', 'radial: bearing radius minus pin radius', default='0.0', example='2.0e-5'), &
      real_key('joint', 'bearing_radius', 'm', '> 0', 'radius of the piston''s bore', default='0.0', example='0.010'), &
      real_key('joint', 'bearing_length', 'm', '> 0', 'its width, for a film', default='0.0', example='0.015')]
  end function joint_keys

  pure function model_keys() result(keys)
    type(key_t), allocatable :: keys(:)
    character(len=*), parameter :: c = 'contact', l = 'lubrication'
    keys = [ &
      word_key(c, 'law', 'lankarani_nikravesh', 'lankarani_nikravesh, hertz', 'hertz: without dissipation'), &
      real_key(c, 'restitution', '', '>= 0 and <= 1', 'coefficient of restitution', default='0.9'), &
      real_key(c, 'exponent', '', '>= 1', 'of the penetration', default='1.5'), &
      real_key(c, 'youngs_modulus', 'Pa', '> 0', 'of pin and bearing', default='207.0e9', count=2), &
      real_key(c, 'poissons_ratio', '', '>= 0 and <= 0.5', 'of pin and bearing', default='0.3', count=2), &
      real_key(c, 'density', 'kg/m^3', '> 0', 'of pin and bearing, for the limit of validity', default='7850.0', count=2), &
      real_key(c, 'stiffness', 'N/m^exponent', '> 0', '0: from the materials', default='0.0'), &
      real_key(c, 'least_impact_speed', 'm/s', '>= 1e-9 and <= 1', &
               'lankarani_nikravesh: slower impacts are damped as one of this speed', default='1.0e-5'), &
      word_key('friction', 'law', 'ambrosio', 'ambrosio, coulomb', 'ambrosio: grows from 0 at v0 to full at v1'), &
      real_key('friction', 'coefficient', '', '>= 0', 'of sliding friction', example='0.03'), &
      real_key('friction', 'v0', 'm/s', '>= 0', 'needed by ambrosio', default='0.0', example='0.001'), &
      real_key('friction', 'v1', 'm/s', '>= 0', 'needed by ambrosio', default='0.0', example='0.010'), &
      word_key(l, 'law', 'pinkus_sternlicht', 'pinkus_sternlicht, oscillating_film', 'journal bearing or oscillating film'), &
      word_key(l, 'variant', '', 'closed_form, as_printed, half_film, bearing_frame', 'its own default where not given', &
               example='closed_form'), &
      real_key(l, 'viscosity', 'Pa s', '> 0', 'dynamic viscosity', example='0.0117'), &
      real_key(l, 'kinematic_viscosity', 'm^2/s', '> 0', 'needed by oscillating_film', default='0.0', example='1.38e-5'), &
      integer_key(l, 'quadrature_points', '>= 4 and <= 1000000', '0: chosen from the tolerance', default='0'), &
      real_key(l, 'least_film_ratio', '', '>= 0.000001 and <= 0.5', &
               'oscillating_film is taken no thinner than this part of the clearance', default='0.001')]
  end function model_keys

  pure function combustion_keys() result(keys)
    type(key_t), allocatable :: keys(:)
    character(len=*), parameter :: c = 'combustion'
    keys = [ &
      real_key(c, 'bore', 'm', '>= 1e-6 and <= 1e3', 'cylinder diameter', example='0.070'), &
      real_key(c, 'compression_ratio', '', '> 1 and <= 1000', 'largest over smallest volume', example='9.0'), &
      real_key(c, 'heat_capacity_ratio', '', '> 1 and <= 10', 'of the gas', example='1.4'), &
      real_key(c, 'heat', 'J', '>= 0 and <= 1e12', 'released in a cycle', example='165.0'), &
      real_key(c, 'wiebe_efficiency', '', '> 0 and <= 1000', 'a of the Wiebe function', example='5.0'), &
      real_key(c, 'wiebe_form', '', '>= 0.05 and <= 100', 'n of the Wiebe function', example='3.0'), &
      real_key(c, 'start_deg', 'degrees', '>= 180 and < 540', 'start of combustion; firing dead centre is 360', &
               example='340.0'), &
      real_key(c, 'duration_deg', 'degrees', '> 0', 'of combustion, which ends by 540', example='40.0'), &
      real_key(c, 'intake_pressure', 'Pa', '> 0', 'in the open cylinder', default='101325.0'), &
      real_key(c, 'crankcase_pressure', 'Pa', '> 0', 'under the piston', default='101325.0')]
  end function combustion_keys

  pure function run_keys() result(keys)
    type(key_t), allocatable :: keys(:)
    character(len=*), parameter :: i = 'integrator', o = 'output'
    keys = [ &
      word_key(i, 'method', 'auto', 'auto, adams, radau', &
               'adams: Shampine and Gordon; radau: implicit; auto: as the phase needs'), &
      real_key(i, 'revolutions', '', '> 0', '0: end_time is given', default='0.0', example='4.0', family='end'), &
      real_key(i, 'end_time', 's', '> 0', '0: revolutions is given', default='0.0', family='end'), &
      real_key(i, 'relative_tolerance', '', '> 0 and <= 0.1', 'of each step; above 1e-3 it counts as 1e-3', &
               default='1.0e-6'), &
      real_key(i, 'absolute_tolerance', '', '> 0 and <= 0.1', '0: relative_tolerance by the natural scales', default='0.0'), &
      real_key(i, 'max_step', 's', '> 0', '0: no limit', default='0.0'), &
      integer_key(i, 'max_order', '>= 1 and <= 12', 'of the method', default='12'), &
      word_key(i, 'contact_entry', 'root', 'root, step_rejection', 'how the start of a contact is found'), &
      real_key(i, 'max_penetration', 'm', '> 0', 'limit at contact entry, needed by step_rejection', default='0.0'), &
      integer_key(i, 'max_steps', '> 0', '0: no limit', default='0'), &
      integer_key(i, 'max_evaluations', '> 0 and <= 2000000000', &
                  'of the right-hand side: a run that needs more ends there, exit status 4', default='1000000000'), &
      integer_key(i, 'max_evaluations_per_revolution', '> 0 and <= 2000000000', 'the same within a revolution; 0: no limit', &
                  default='100000000'), &
      integer_key(o, 'samples_per_revolution', '>= 1 and <= 1000000', 'rows in a revolution', default='720'), &
      real_key(o, 'interval', 's', '> 0', 'between rows; 0: samples_per_revolution counts', default='0.0'), &
      real_key(o, 'start_time', 's', '>= 0', 'of the first row', default='0.0'), &
      text_key(o, 'columns', 'standard', '''standard'', or names of columns without their units, with commas', many=.true.), &
      integer_key(o, 'digits', '>= 9 and <= 17', 'significant, of every number in a trace; 17 read back exactly', default='10'), &
      logical_key(o, 'every_step', 'a row also at each step of the integrator', default='.false.'), &
      logical_key(o, 'ideal_twin', 'run the same scene with an ideal joint too', default='.false.')]
  end function run_keys

  !> A key that has no default is required.
  pure function real_key(group, name, unit, range, description, default, example, count, family) result(key)
    character(len=*), intent(in) :: group, name, unit, range, description
    character(len=*), intent(in), optional :: default, example, family
    integer, intent(in), optional :: count
    type(key_t) :: key
    key = key_t(group=group, name=name, unit=unit, range=range, description=description, required=.not. present(default))
    if (present(default)) key%default = default
    if (present(example)) key%example = example
    if (present(count)) key%count = count
    if (present(family)) key%family = family
  end function real_key

  pure function integer_key(group, name, range, description, default) result(key)
    character(len=*), intent(in) :: group, name, range, description, default
    type(key_t) :: key
    key = key_t(group=group, name=name, kind=integer_kind, range=range, description=description, default=default)
  end function integer_key

  pure function logical_key(group, name, description, default) result(key)
    character(len=*), intent(in) :: group, name, description, default
    type(key_t) :: key
    key = key_t(group=group, name=name, kind=logical_kind, description=description, default=default)
  end function logical_key

  pure function word_key(group, name, default, words, description, example) result(key)
    character(len=*), intent(in) :: group, name, default, words, description
    character(len=*), intent(in), optional :: example
    type(key_t) :: key
    key = key_t(group=group, name=name, kind=word_kind, default=default, words=words, description=description)
    if (present(example)) key%example = example
  end function word_key

  !> A text; with `many`, several texts are joined by commas.
  pure function text_key(group, name, default, description, many) result(key)
    character(len=*), intent(in) :: group, name, default, description
    logical, intent(in), optional :: many
    type(key_t) :: key
    key = key_t(group=group, name=name, kind=text_kind, default=default, description=description)
    if (present(many)) key%count = merge(1000, 1, many)
  end function text_key

  !> Place of a key in the table; 0 where there is none.
  pure function find_key(keys, group, name) result(place)
    type(key_t), intent(in) :: keys(:)
    character(len=*), intent(in) :: group, name
    integer :: place
    character(len=1) :: letter
    letter = name
    do place = size(keys), 1, -1
      if (keys(place)%name(1:1) /= letter) cycle   ! nearly all of them, in no time
      if (keys(place)%group == group .and. keys(place)%name == name) return
    end do
  end function find_key

  !> Place of a group in the table; 0 where there is none.
  pure function find_group(groups, name) result(place)
    type(group_definition_t), intent(in) :: groups(:)
    character(len=*), intent(in) :: name
    integer :: place
    do place = size(groups), 1, -1
      if (groups(place)%name == name) return
    end do
  end function find_group
end module case_schema
