!> What acts on the piston in its bore: the abstract element of the guide.
!>
!> A guide has a list of elements, which all act at the same time: friction, corners of the skirt. An element adds its loads to
!> those of the guide, and its columns to a row; states of its own it declares as components. A new kind is one file, and two lines
!> in `guide_elements`.
module guide_element
  use kinds, only: dp
  use state_layout, only: slice_t
  use trace_row, only: trace_row_t
  use chain_motion, only: motion_t, tilting_t
  use contact_law, only: contact_law_t
  use piston_skirt, only: skirt_t, corner_t, n_corners
  use guide_case, only: guide_case_t
  use ring_case, only: most_piston_rings
  use face_film, only: face_loads_t, face_motion_t, face_tangent_t, faces_t
  implicit none
  private
  public :: guide_element_t, guide_loads_t, ring_now_t, most_guide_states, deepest

  integer, parameter :: most_guide_states = 10   !! of all elements of a guide
  real(dp), parameter :: deepest = -3   !! least gap of a film over the roughness for which the model of asperities holds

  !> A piston ring.
  type :: ring_now_t
    real(dp) :: friction          !! on the piston along x [N]
    real(dp) :: least_gap         !! of a film [m]
    real(dp) :: asperities        !! force of the asperities beside a film [N]
  end type ring_now_t

  !> Loads of the guide on the piston.
  type :: guide_loads_t
    ! what elements may depend on, besides the motion
    real(dp) :: speed             !! of the piston along x; with clearance that of its centre of mass [m/s]
    real(dp) :: gas_force         !! of the gas on the piston along -x [N]
    ! the sums over the elements
    real(dp) :: friction_force    !! along x [N]
    real(dp) :: friction_ratio    !! further friction over the normal force of an ideal guide, opposite in sign to the speed [-]
    real(dp) :: force             !! with clearance: along y [N]
    real(dp) :: moment            !! with clearance: about the centre of mass, positive from x to y [N m]
    ! of single elements
    real(dp) :: rates(most_guide_states)  !! of the states of the elements
    type(corner_t) :: corner(n_corners)   !! with clearance in the bore
    type(face_loads_t) :: skirt           !! of the film of the skirt
    real(dp) :: skirt_power               !! that it takes [W]
    type(face_tangent_t) :: tangent       !! of that film
    real(dp) :: deflection(n_corners)     !! of elastic faces at their ends, away from the wall [m]
    real(dp) :: spring_energy             !! stored in them [J]
    real(dp) :: spring_power              !! its rate [W]
    logical :: springs_balance            !! at the rates of these deflections; else the loads are not known
    type(ring_now_t) :: ring(most_piston_rings)
  end type guide_loads_t

  type, abstract :: guide_element_t
    class(contact_law_t), allocatable :: contact   !! of a corner of the skirt with the bore; not allocated: the element has none
    ! first-order states
    integer :: n_states = 0
    character(len=24) :: state_name = ''    !! of all of them, in files of states
    character(len=8) :: state_unit = ''
    real(dp) :: state_scale(most_guide_states) = 1   !! natural sizes
    real(dp) :: start(most_guide_states) = 0         !! values at t = 0
    type(slice_t) :: states   !! their indices in the state vector, set by the guide
    type(slice_t) :: rates    !! those of their rates in `guide_loads_t`, set by the guide
  contains
    procedure(prepare), deferred :: prepare
    procedure(find_loads), deferred :: find_loads
    procedure :: admits => all_places
    procedure :: add_columns => no_columns
    procedure :: see_faces => no_faces
    procedure, non_overridable :: normal_force
  end type guide_element_t

  abstract interface
    !> Accept the laws that a case gives to the guide, prepare them, and declare states.
    subroutine prepare(self, wanted)
      import :: guide_element_t, guide_case_t
      class(guide_element_t), intent(inout) :: self
      type(guide_case_t), intent(in) :: wanted
    end subroutine prepare

    !> Add the loads of the element on the piston, and set the rates of its states. Their power is that of the sums.
    pure subroutine find_loads(self, skirt, motion, y, now)
      import :: guide_element_t, skirt_t, motion_t, guide_loads_t, dp
      class(guide_element_t), intent(in) :: self
      type(skirt_t), intent(in) :: skirt
      type(motion_t), intent(in) :: motion
      real(dp), intent(in) :: y(*)   !! the whole state vector, for the states of the element
      type(guide_loads_t), intent(inout) :: now
    end subroutine find_loads
  end interface

contains

  !> Whether the element is defined in this state and, with clearance, where the piston is: everywhere.
  pure logical function all_places(self, y, tilting) result(admits)
    class(guide_element_t), intent(in) :: self
    real(dp), intent(in) :: y(*)
    type(tilting_t), intent(in) :: tilting
    admits = .true.
  end function all_places

  !> Add the columns of the element to a row: none.
  pure subroutine no_columns(self, now, row)
    class(guide_element_t), intent(in) :: self
    type(guide_loads_t), intent(in) :: now
    type(trace_row_t), intent(inout) :: row
  end subroutine no_columns

  !> The films of the skirt at a motion of the piston and deflections of its faces, with heights above the pin: none.
  subroutine no_faces(self, motion, deflection, faces)
    class(guide_element_t), intent(in) :: self
    type(face_motion_t), intent(in) :: motion
    real(dp), intent(in) :: deflection(n_corners)
    type(faces_t), intent(out) :: faces
  end subroutine no_faces

  !> Normal force of corner i [N]; 0 without contact.
  pure real(dp) function normal_force(self, skirt, i, corner)
    class(guide_element_t), intent(in) :: self
    type(skirt_t), intent(in) :: skirt
    integer, intent(in) :: i
    type(corner_t), intent(in) :: corner
    normal_force = 0
    if (skirt%touches(i) .and. .not. skirt%force_is_lost(i)) &
      normal_force = self%contact%normal_force(corner%depth, corner%depth_rate, skirt%impact_speed(i))
  end function normal_force
end module guide_element
